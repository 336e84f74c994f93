// Canonical JSON of large values, written without a tree of them.
#pragma once

#include <string>
#include <string_view>

#include "base/canonical_json.h"

namespace seedframe {

/// Appends to a text. Keys must come in byte order. A function that is given the writer and a value
/// writes the fields of an object.
class CanonicalWriter {
 public:
  explicit CanonicalWriter(std::string& out) : out_(out) {}

  template <class T, class Write>
  void object(const T& value, const Write& write) {
    open('{');
    write(*this, value);
    close('}');
  }
  void number(double value) { append_canonical(out_, value); }
  void text(std::string_view value) { append_canonical(out_, value); }
  void null() { out_ += "null"; }
  template <class Numbers>
  void numbers(const Numbers& values) {
    items(values, [this](const auto& value) { number(static_cast<double>(value)); });
  }
  /// Row by row.
  template <class Matrix>
  void matrix(const Matrix& values) {
    open('[');
    for (int row = 0; row < values.rows(); ++row) {
      for (int column = 0; column < values.cols(); ++column) {
        separate();
        number(values(row, column));
      }
    }
    close(']');
  }

  void field(std::string_view name, double value) {
    key(name);
    number(value);
  }
  void field(std::string_view name, std::string_view value) {
    key(name);
    text(value);
  }
  void field(std::string_view name, const std::string& value) {
    field(name, std::string_view(value));
  }
  void field(std::string_view name, bool value) {
    key(name);
    out_ += value ? "true" : "false";
  }
  template <class Numbers>
  void numbers(std::string_view name, const Numbers& values) {
    key(name);
    numbers(values);
  }
  template <class Matrix>
  void matrix(std::string_view name, const Matrix& values) {
    key(name);
    matrix(values);
  }
  template <class T, class Write>
  void object(std::string_view name, const T& value, const Write& write) {
    key(name);
    object(value, write);
  }
  /// `write` writes an item.
  template <class Items, class Write>
  void list(std::string_view name, const Items& values, const Write& write) {
    key(name);
    items(values, write);
  }
  template <class Items, class Write>
  void objects(std::string_view name, const Items& values, const Write& write) {
    list(name, values, [&](const auto& value) { object(value, write); });
  }

 private:
  template <class Items, class Write>
  void items(const Items& values, const Write& write) {
    open('[');
    for (const auto& value : values) {
      separate();
      write(value);
    }
    close(']');
  }
  void key(std::string_view name) {
    separate();
    out_ += '"';
    out_ += name;
    out_ += "\":";
  }
  void open(char bracket) {
    out_ += bracket;
    first_ = true;
  }
  void close(char bracket) {
    out_ += bracket;
    first_ = false;
  }
  void separate() {
    if (!first_) out_ += ',';
    first_ = false;
  }

  std::string& out_;
  bool first_ = true;
};

/// What readable_json gives for the value of a canonical text.
std::string readable_layout(std::string_view canonical);

}  // namespace seedframe
