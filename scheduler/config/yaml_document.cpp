#include "config/yaml_document.h"

#include <optional>
#include <sstream>

#include <yaml-cpp/eventhandler.h>

#include "config/config_text.h"
#include "config/yaml_size.h"

namespace seedframe {
namespace {

/// Notes where the first value of a document begins; one without a value has none.
class FirstValue : public YAML::EventHandler {
 public:
  const std::optional<YAML::Mark>& place() const { return place_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { note(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    note(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    note(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    note(mark);
  }
  void OnMapEnd() override {}

 private:
  void note(const YAML::Mark& mark) {
    if (!place_) place_ = mark;
  }

  std::optional<YAML::Mark> place_;
};

std::string place_text(const std::string& file, const YAML::Mark& mark) {
  return mark.is_null() ? file : fmt::format("{}:{}:{}", file, mark.line + 1, mark.column + 1);
}

/// Where a second document begins, if one does. Not by YAML::LoadAll, which some broken texts give
/// documents for ever, and then there is no memory.
std::optional<YAML::Mark> second_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  FirstValue first, second;
  if (!parser.HandleNextDocument(first) || !parser.HandleNextDocument(second)) return std::nullopt;
  return second.place();
}

}  // namespace

Result<YAML::Node> read_yaml_document(const std::string& text, const std::string& file) {
  if (Status readable = check_config_text(text, file); !readable) return forward_error(readable);
  if (Status small = check_yaml_size(text, file); !small) return forward_error(small);
  try {
    const YAML::Node document = YAML::Load(text);
    if (const auto second = second_document(text)) {
      return fail(ErrorKind::kInput, "{}: a config is one YAML document, and here a second begins",
                  place_text(file, *second));
    }
    return document;
  } catch (const YAML::ParserException& error) {
    return fail(ErrorKind::kInput, "{}: this is not YAML: {}", place_text(file, error.mark),
                error.msg);
  } catch (const YAML::Exception& error) {
    return fail(ErrorKind::kInput, "{}: this is not YAML: {}", file, error.what());
  }
}

}  // namespace seedframe
