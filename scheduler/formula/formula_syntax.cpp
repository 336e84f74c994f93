#include "formula/formula_syntax.h"

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

namespace seedframe {
namespace {

constexpr std::size_t kLongestFormula = 2000;
constexpr int kDeepest = 100;

struct Token {
  enum class Kind { kEnd, kNumber, kText, kName, kSymbol };
  Kind kind = Kind::kEnd;
  std::string_view text;
  double value = 0.0;
  std::size_t begin = 0;  ///< index of its first character
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) { advance(); }

  Result<FormulaNode> run() {
    FormulaNode root = condition();
    if (!error_.empty()) return fault();
    if (token_.kind != Token::Kind::kEnd) {
      refuse(token_.text == "," ? "a formula has one result"
                                : "expected an operator, found '" + std::string(token_.text) + "'");
    }
    if (!error_.empty()) return fault();
    return root;
  }

 private:
  tl::unexpected<Error> fault() const { return fail(ErrorKind::kInput, "'{}': {}", text_, error_); }

  void refuse(const std::string& reason) {
    if (error_.empty()) error_ = fmt::format("{} (character {})", reason, token_.begin + 1);
    token_ = {};  // so that everything ends soon
    position_ = text_.size();
  }

  void advance() {
    while (position_ < text_.size() && (text_[position_] == ' ' || text_[position_] == '\t' ||
                                        text_[position_] == '\n' || text_[position_] == '\r')) {
      ++position_;
    }
    token_ = {};
    token_.begin = position_;
    if (position_ == text_.size()) return;
    const char c = text_[position_];
    const bool fraction =
        c == '.' && position_ + 1 < text_.size() && is_digit(text_[position_ + 1]);
    if (is_digit(c) || fraction) {
      read_number();
    } else if (is_letter(c)) {
      std::size_t end = position_;
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
      take(Token::Kind::kName, end - position_);
    } else if (c == '\'' || c == '"') {
      const std::size_t close = text_.find(c, position_ + 1);
      if (close == std::string_view::npos) {
        refuse("a text that begins with a quote must end with one");
        return;
      }
      token_.kind = Token::Kind::kText;
      token_.text = text_.substr(position_ + 1, close - position_ - 1);
      position_ = close + 1;
    } else {
      read_symbol();
    }
  }

  void take(Token::Kind kind, std::size_t length) {
    token_.kind = kind;
    token_.text = text_.substr(position_, length);
    position_ += length;
  }

  void read_number() {
    const char* begin = text_.data() + position_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), token_.value);
    const auto length = static_cast<std::size_t>(end - begin);
    if (error != std::errc() || length == 0) {
      refuse("this number is too large or too small");
      return;
    }
    take(Token::Kind::kNumber, length);
  }

  void read_symbol() {
    static constexpr std::array<std::string_view, 6> kTwo = {"<=", ">=", "==", "!=", "&&", "||"};
    for (const std::string_view symbol : kTwo) {
      if (text_.substr(position_, 2) == symbol) {
        take(Token::Kind::kSymbol, 2);
        return;
      }
    }
    const char c = text_[position_];
    if (std::string_view("+-*/<>!?:(),[].").find(c) != std::string_view::npos) {
      take(Token::Kind::kSymbol, 1);
    } else if (c == '^') {
      refuse("write pow(x, y) instead of x ^ y");
    } else if (c == '=') {
      refuse("a formula assigns nothing; write == to compare");
    } else {
      std::size_t end = position_ + 1;  // of a character of several bytes in UTF-8
      while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0u) == 0x80u) ++end;
      refuse(fmt::format("'{}' has no meaning here", text_.substr(position_, end - position_)));
    }
  }

  bool at(std::string_view symbol) const {
    return token_.kind == Token::Kind::kSymbol && token_.text == symbol;
  }
  bool skip(std::string_view symbol) {
    if (!at(symbol)) return false;
    advance();
    return true;
  }
  void expect(std::string_view symbol) {
    if (skip(symbol) || !error_.empty()) return;
    refuse(fmt::format("expected '{}'{}", symbol,
                       token_.kind == Token::Kind::kEnd
                           ? ", but the formula ends"
                           : fmt::format(", found '{}'", token_.text)));
  }

  FormulaNode condition() {
    if (++depth_ > kDeepest) {
      refuse("this formula is nested too deeply");
      return {};
    }
    FormulaNode node = binary(0);
    if (skip("?")) {
      FormulaNode choice{FormulaNode::Kind::kCondition, "?", 0.0, {}};
      choice.children.push_back(std::move(node));
      choice.children.push_back(condition());
      expect(":");
      choice.children.push_back(condition());
      node = std::move(choice);
    }
    --depth_;
    return node;
  }

  FormulaNode binary(std::size_t level) {
    static const std::array<std::vector<std::string_view>, 5> levels = {
        {{"||"}, {"&&"}, {"==", "!=", "<", "<=", ">", ">="}, {"+", "-"}, {"*", "/"}}};
    if (level == levels.size()) return unary();
    FormulaNode left = binary(level + 1);
    for (bool found = true; found;) {
      found = false;
      for (const std::string_view symbol : levels[level]) {
        if (!at(symbol)) continue;
        FormulaNode node{FormulaNode::Kind::kOperator, std::string(symbol), 0.0, {}};
        advance();
        node.children.push_back(std::move(left));
        node.children.push_back(binary(level + 1));
        left = std::move(node);
        found = true;
        break;
      }
    }
    return left;
  }

  FormulaNode unary() {
    for (const std::string_view symbol : {"-", "+", "!"}) {
      if (!at(symbol)) continue;
      if (++depth_ > kDeepest) {
        refuse("this formula is nested too deeply");
        return {};
      }
      FormulaNode node{FormulaNode::Kind::kOperator, std::string(symbol), 0.0, {}};
      advance();
      node.children.push_back(unary());
      --depth_;
      return node;
    }
    FormulaNode node = primary();
    while (at(".") || at("[")) {
      FormulaNode member{FormulaNode::Kind::kMember, "", 0.0, {}};
      const bool dot = skip(".");
      if (!dot) expect("[");
      if (token_.kind != (dot ? Token::Kind::kName : Token::Kind::kNumber)) {
        refuse(dot ? "expected x, y or z after '.'" : "expected 0, 1 or 2 after '['");
        return {};
      }
      member.text = std::string(token_.text);
      advance();
      if (!dot) expect("]");
      member.children.push_back(std::move(node));
      node = std::move(member);
    }
    return node;
  }

  FormulaNode primary() {
    const Token token = token_;
    switch (token.kind) {
      case Token::Kind::kNumber: {
        advance();
        FormulaNode node{FormulaNode::Kind::kNumber, "", token.value, {}};
        if (token_.kind == Token::Kind::kName) {  // its unit
          node.text = std::string(token_.text);
          advance();
        }
        return node;
      }
      case Token::Kind::kText:
        advance();
        return {FormulaNode::Kind::kText, std::string(token.text), 0.0, {}};
      case Token::Kind::kName: {
        advance();
        if (!skip("(")) return {FormulaNode::Kind::kName, std::string(token.text), 0.0, {}};
        FormulaNode call{FormulaNode::Kind::kCall, std::string(token.text), 0.0, {}};
        list(call, ")");
        return call;
      }
      default:
        break;
    }
    if (skip("(")) {
      FormulaNode inner = condition();
      expect(")");
      return inner;
    }
    if (skip("[")) {
      FormulaNode vector{FormulaNode::Kind::kVector, "[", 0.0, {}};
      list(vector, "]");
      return vector;
    }
    refuse(token.kind == Token::Kind::kEnd
               ? "expected a value, but the formula ends"
               : fmt::format("expected a value, found '{}'", token.text));
    return {};
  }

  void list(FormulaNode& parent, std::string_view close) {
    if (skip(close)) return;
    do {
      parent.children.push_back(condition());
    } while (skip(","));
    expect(close);
  }

  std::string_view text_;
  std::size_t position_ = 0;
  Token token_;
  int depth_ = 0;
  std::string error_;
};

}  // namespace

Result<FormulaNode> parse_formula(const std::string& text) {
  if (text.size() > kLongestFormula) {
    return fail(ErrorKind::kInput, "a formula may have {} characters, this one has {}",
                kLongestFormula, text.size());
  }
  return Parser(text).run();
}

}  // namespace seedframe
