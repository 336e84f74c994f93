#include "tests/stability/figures.h"

namespace seedframe {
namespace {

ErrorQuantiles quantiles_of(const ErrorSamples& errors) {
  return {errors.quantile(0.5), errors.quantile(0.99), errors.quantile(1.0)};
}

Json json_of(const ErrorQuantiles& errors) {
  return {{"median", errors.median}, {"p99", errors.p99}, {"most", errors.most}};
}

Json json_of(const AgreementFigures& agreement) {
  return {{"pixels", agreement.pixels},
          {"wrong", agreement.wrong},
          {"depth_ulp", json_of(agreement.depth_ulp)},
          {"normal_deg", json_of(agreement.normal_deg)}};
}

ErrorQuantiles quantiles_from(const Json& json) {
  return {json.at("median").get<double>(), json.at("p99").get<double>(),
          json.at("most").get<double>()};
}

AgreementFigures agreement_from(const Json& json) {
  return {integer_of<std::int64_t>(json.at("pixels")), integer_of<std::int64_t>(json.at("wrong")),
          quantiles_from(json.at("depth_ulp")), quantiles_from(json.at("normal_deg"))};
}

}  // namespace

AgreementFigures figures_of(const Agreement& agreement) {
  return {agreement.pixels, agreement.wrong, quantiles_of(agreement.depth_ulp),
          quantiles_of(agreement.normal_deg)};
}

Json to_json(const CaseFigures& figures) {
  Json blenders = Json::array();
  for (const BlenderFigures& each : figures.blenders) {
    blenders.push_back({{"version", each.version},
                        {"failure", each.failure},
                        {"inside_px", each.inside_px},
                        {"edge_px", each.edge_px},
                        {"complaint", each.complaint},
                        {"twin_right", each.judgement.twin},
                        {"blender_right", each.judgement.blender},
                        {"nobody_right", each.judgement.nobody},
                        {"ties", each.judgement.ties},
                        {"agreement", json_of(each.agreement)}});
  }
  return {{"axis", figures.axis},
          {"name", figures.name},
          {"at", figures.at ? Json(*figures.at) : Json()},
          {"frames", figures.frames},
          {"asked", figures.asked},
          {"twin_moved", figures.twin_moved},
          {"twin", json_of(figures.twin)},
          {"blenders", blenders}};
}

CaseFigures case_figures_from_json(const Json& json) {
  CaseFigures figures;
  figures.axis = json.at("axis").get<std::string>();
  figures.name = json.at("name").get<std::string>();
  if (!json.at("at").is_null()) figures.at = json.at("at").get<double>();
  figures.frames = integer_of<std::size_t>(json.at("frames"));
  figures.asked = integer_of<std::int64_t>(json.at("asked"));
  figures.twin_moved = integer_of<std::int64_t>(json.at("twin_moved"));
  figures.twin = agreement_from(json.at("twin"));
  for (const Json& each : json.at("blenders")) {
    BlenderFigures& blender = figures.blenders.emplace_back();
    blender.version = each.at("version").get<std::string>();
    blender.failure = each.at("failure").get<std::string>();
    blender.inside_px = integer_of<std::int64_t>(each.at("inside_px"));
    blender.edge_px = integer_of<std::int64_t>(each.at("edge_px"));
    blender.complaint = each.at("complaint").get<std::string>();
    blender.judgement = {integer_of<std::int64_t>(each.at("twin_right")),
                         integer_of<std::int64_t>(each.at("blender_right")),
                         integer_of<std::int64_t>(each.at("nobody_right")),
                         integer_of<std::int64_t>(each.at("ties"))};
    blender.agreement = agreement_from(each.at("agreement"));
  }
  return figures;
}

}  // namespace seedframe
