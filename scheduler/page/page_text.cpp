#include "page/page_text.h"

#include <map>

#include "base/sha256.h"
#include "page/packed.h"
#include "page/web_files.h"

namespace seedframe {
namespace {

/// As Content-Security-Policy names an inline script or style.
std::string policy_hash(std::string_view text) {
  const std::string hex = sha256_hex(text);
  std::string digest;
  constexpr int kHex = 16;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    digest += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, kHex));
  }
  return "'sha256-" + base64(digest) + "'";
}

/// Our scripts share one scope, and leave nothing in the page's.
std::string wrapped_script() {
  return "(() => {\n'use strict';\n" + std::string(web::kScript) + "})();\n";
}

std::string policy_of(const std::string& script, const PageAccess& access) {
  std::string scripts = policy_hash(web::kChart) + " " + policy_hash(script);
  if (access.loads_parts) scripts += " 'self' file:";
  return "default-src 'none'; script-src " + scripts + "; style-src " + policy_hash(web::kStyle) +
         "; img-src data: blob:" + (access.connects ? " 'self'; connect-src 'self'" : "") +
         "; base-uri 'none'; form-action 'none'";
}

/// The template with each {{name}} replaced, in one pass: what is put in is not looked at again.
std::string filled(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string result;
  while (!text.empty()) {
    const std::size_t open = text.find("{{");
    const std::size_t close = open == std::string_view::npos ? open : text.find("}}", open);
    if (close == std::string_view::npos) break;
    result += text.substr(0, open);
    result += values.at(std::string(text.substr(open + 2, close - open - 2)));
    text.remove_prefix(close + 2);
  }
  return result += text;
}

}  // namespace

std::string script_json(const Json& value) {
  const std::string text = canonical_json(value);
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string html_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

PageText page_text(const Json& data, const PageAccess& access) {
  const std::string script = wrapped_script();
  const std::string& name = data.at("campaign").at("name").get_ref<const std::string&>();
  constexpr std::string_view kParts = "{{parts}}";
  const std::size_t at = web::kTemplate.find(kParts);
  Json shown = data;
  shown["chart_license"] = web::kChartLicense;
  PageText page;
  page.begin =
      filled(web::kTemplate.substr(0, at), {{"policy", html_text(policy_of(script, access))},
                                            {"title", html_text(name)},
                                            {"style", std::string(web::kStyle)},
                                            {"chart", std::string(web::kChart)},
                                            {"script", script},
                                            {"data", script_json(shown)}});
  page.end = web::kTemplate.substr(at + kParts.size());
  return page;
}

std::string part_element(int part, const Json& content) {
  return fmt::format("<script type=\"application/json\" id=\"part-{}\">{}</script>\n", part,
                     script_json(content));
}

}  // namespace seedframe
