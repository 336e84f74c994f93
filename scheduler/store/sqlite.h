// A thin layer over SQLite's C interface: statements that free themselves, failures as values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <sqlite3.h>

#include "base/error.h"

namespace seedframe::sqlite {

class Connection {
 public:
  Connection() = default;
  ~Connection() { sqlite3_close_v2(handle_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Status open(const std::filesystem::path& path, int flags) {
    path_ = path;
    if (sqlite3_open_v2(path.c_str(), &handle_, flags, nullptr) != SQLITE_OK)
      return failure("open");
    sqlite3_extended_result_codes(handle_, 1);
    sqlite3_busy_timeout(handle_, 10'000);
    return {};
  }

  /// Of a file that nobody changes meanwhile: needs no files beside it, as a WAL and its index are.
  Status open_unchanging(const std::filesystem::path& path) {
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(path).string()) {
      const bool has_meaning = c == '%' || c == '?' || c == '#';
      uri +=
          has_meaning ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
    }
    Status opened = open(uri + "?immutable=1", SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
    path_ = path;
    return opened;
  }

  Status execute(const char* sql) const {
    if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) return failure("use");
    return {};
  }

  tl::unexpected<Error> failure(const char* action) const {
    return fail(kind_of(sqlite3_errcode(handle_)), "cannot {} the job store {}: {}", action,
                path_.string(), sqlite3_errmsg(handle_));
  }

  static ErrorKind kind_of(int code) {
    switch (code & 0xff) {
      case SQLITE_NOTADB:
      case SQLITE_CORRUPT:
      case SQLITE_ERROR:
        return ErrorKind::kCorrupt;
      case SQLITE_FULL:
      case SQLITE_IOERR:
      case SQLITE_READONLY:
      case SQLITE_CANTOPEN:  // too many open files, too
      case SQLITE_NOMEM:
        return ErrorKind::kExhausted;
      default:
        return ErrorKind::kEnvironment;
    }
  }

  sqlite3* handle() const { return handle_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  sqlite3* handle_ = nullptr;
  std::filesystem::path path_;
};

/// A prepared statement. A failure of prepare, bind or step is kept and told by status().
class Statement {
 public:
  Statement(const Connection& connection, const char* sql) : connection_(connection) {
    ok_ = sqlite3_prepare_v2(connection.handle(), sql, -1, &handle_, nullptr) == SQLITE_OK;
  }
  ~Statement() { sqlite3_finalize(handle_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(int index, std::int64_t value) {
    return check(sqlite3_bind_int64(handle_, index, value) == SQLITE_OK);
  }
  Statement& bind(int index, double value) {
    return check(sqlite3_bind_double(handle_, index, value) == SQLITE_OK);
  }
  Statement& bind(int index, const std::string& value) {
    return check(sqlite3_bind_text(handle_, index, value.data(), static_cast<int>(value.size()),
                                   SQLITE_TRANSIENT) == SQLITE_OK);
  }

  /// True while there is a row.
  bool step() {
    if (!ok_) return false;
    const int code = sqlite3_step(handle_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) ok_ = false;
    return code == SQLITE_ROW;
  }
  Status run() {
    step();
    return status();
  }
  void reset() {
    sqlite3_reset(handle_);
    sqlite3_clear_bindings(handle_);
  }

  std::int64_t integer(int column) const { return sqlite3_column_int64(handle_, column); }
  double real(int column) const { return sqlite3_column_double(handle_, column); }
  std::string text(int column) const {
    const unsigned char* value = sqlite3_column_text(handle_, column);
    return value == nullptr ? std::string() : reinterpret_cast<const char*>(value);
  }

  Status status() const {
    if (ok_) return {};
    return connection_.failure("use");
  }

 private:
  Statement& check(bool ok) {
    ok_ = ok_ && ok;
    return *this;
  }

  const Connection& connection_;
  sqlite3_stmt* handle_ = nullptr;
  bool ok_ = false;
};

}  // namespace seedframe::sqlite
