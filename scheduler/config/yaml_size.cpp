#include "config/yaml_size.h"

#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "base/utf8.h"

namespace seedframe {
namespace {

struct Unfit {
  YAML::Mark mark;
  std::string reason;
};

class NodeCounter : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { count(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    count(mark);
    // yaml-cpp makes single bytes of "\N" and "\_".
    if (!is_utf8(value)) throw Unfit{mark, "this text is not UTF-8"};
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnMapEnd() override { --depth_; }

 private:
  void count(const YAML::Mark& mark) {
    if (++nodes_ <= kMostYamlNodes) return;
    throw Unfit{mark, fmt::format("the config has more than {} values", kMostYamlNodes)};
  }
  void enter(const YAML::Mark& mark) {
    count(mark);
    if (++depth_ <= kDeepestYaml) return;
    throw Unfit{mark, fmt::format("the config has more than {} levels", kDeepestYaml)};
  }

  int nodes_ = 0;
  int depth_ = 0;
};

}  // namespace

Status check_yaml_size(const std::string& text, const std::string& file) {
  const auto fault = [&](const YAML::Mark& mark, const std::string& message) {
    return fail(ErrorKind::kInput, "{}:{}:{}: {}", file, mark.line + 1, mark.column + 1, message);
  };
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    NodeCounter counter;
    // A second one is refused later; of some broken texts yaml-cpp makes documents for ever.
    for (int i = 0; i < 2 && parser.HandleNextDocument(counter); ++i) {
    }
  } catch (const Unfit& error) {
    return fault(error.mark, error.reason);
  } catch (const YAML::ParserException& error) {
    return fault(error.mark, "this is not YAML: " + error.msg);
  } catch (const YAML::Exception& error) {
    return fail(ErrorKind::kInput, "{}: this is not YAML: {}", file, error.what());
  }
  return {};
}

}  // namespace seedframe
