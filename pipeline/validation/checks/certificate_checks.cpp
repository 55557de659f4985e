#include "pipeline/validation/checks/certificate_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace sunder::validation {
namespace {

constexpr Index kMostBlends = 4096;  ///< Vertices whose collapse is bounded: the worst ones.

Result<JointTree> make_tree(const Character& source, const ModelPose& bind,
                            const ValidationOptions& options) {
  Result<JointLimits> limits = options.limits_from == LimitsFrom::clips
                                   ? joint_limits_of_clips(source, bind, options.clip_margin)
                               : options.limits_from == LimitsFrom::given
                                   ? Result<JointLimits>(options.limits)
                                   : free_joint_limits(source, bind);
  if (!limits) return limits.error();
  return JointTree::create(source.skeleton, bind, *limits);
}

/// Why some points have no certificate, in words.
std::string text_of_gaps(const RowReader& reader, std::span<const CertificateGap> gaps) {
  std::string text;
  for (const CertificateGap& gap : gaps) {
    const std::string bone =
        gap.bone == kNone ? std::string()
                          : " of '" + reader.source().character.skeleton.bones[gap.bone].name + "'";
    text += " No certificate for " + std::to_string(gap.count) + " points: ";
    switch (gap.reason) {
      case CertificateGap::Reason::unequal_sums: text += "the sums of weights differ."; break;
      case CertificateGap::Reason::no_slide_range:
        text += "the translation" + bone + " has no range.";
        break;
      case CertificateGap::Reason::no_scale_range:
        text += "the scale" + bone + " has no range.";
        break;
    }
  }
  return text;
}

/// What rounded sums of weights add where a bone slides without a range, in words.
std::string text_of_residuals(const RowReader& reader, const DeviationCertificate& certificate) {
  std::string text;
  for (const SlideResidual& residual : certificate.slide_residuals) {
    char number[32];
    std::snprintf(number, sizeof number, "%.2g", residual.weight);
    text += " The translation of '" + reader.source().character.skeleton.bones[residual.bone].name +
            "' has no range: it adds up to " + number + " m per metre, by rounded weights.";
  }
  return text;
}

std::string text_of_bracket(double found, double certified) {
  char text[160];
  std::snprintf(text, sizeof text,
                "Where there is a certificate, no pose within the limits has more than %.4g m; the "
                "worst pose found has %.4g m.",
                certified, found);
  return text;
}

void certify_deviations(const RowReader& reader, const JointTree& tree,
                        const SkinDifferences& differences, ValidationReport& report,
                        FindingList& findings) {
  DeviationBracket& bracket = report.bracket;
  const Result<DeviationCertificate> certificate = certify_deviation(tree, differences);
  if (!certificate) {
    bracket.why = certificate.error().text();
    return findings.not_tested(Code::cert_deviation, bracket.why);
  }
  bracket.is_tested = true;
  bracket.certified = certificate->maximum;
  bracket.why = text_of_gaps(reader, certificate->gaps) + text_of_residuals(reader, *certificate);
  Places places;
  const double least = kind_of(Code::cert_deviation).threshold * report.diagonal;
  for (Index v = 0; v < certificate->bound.size(); ++v) {
    const double bound = certificate->bound[v];
    const bool is_matched = !std::isnan(report.vertex_deviation[v]);
    report.vertex_bound.push_back(is_matched && std::isfinite(bound)
                                      ? static_cast<float>(bound)
                                      : std::numeric_limits<float>::quiet_NaN());
    if (!std::isfinite(bound)) ++bracket.uncertified;
    if (std::isfinite(bound) && bound > least)
      places.push_back(reader.target().place(v, kNone, bound));
  }
  if (certificate->worst == kNone && certificate->gaps.empty())
    return findings.add(Code::cert_deviation, {});
  if (certificate->worst != kNone) {
    bracket.worst = reader.target().place(certificate->worst, kNone, certificate->maximum);
    if (auto pose = find_worst_pose(tree, differences, certificate->worst)) {
      bracket.found = pose->found;
      bracket.pose = std::move(pose->pose);
    }
  }
  findings.add_finding(Code::cert_deviation, Severity::note, Evidence::certified,
                       text_of_bracket(bracket.found, bracket.certified) + bracket.why,
                       std::move(places), bracket.certified);
}

void certify_cracks(const RowReader& reader, const JointTree& tree, const CrackRows& cracks,
                    FindingList& findings) {
  if (cracks.rows.terms.empty()) return findings.add(Code::cert_crack, {});
  const Result<DeviationCertificate> certificate = certify_deviation(tree, cracks.rows);
  if (!certificate)
    return findings.not_tested(Code::cert_crack, std::string(certificate.error().text()));
  Places places;
  for (std::size_t i = 0; i < certificate->bound.size(); ++i)
    if (std::isfinite(certificate->bound[i]) && certificate->bound[i] > 0.0)
      places.push_back(reader.target().place(cracks.vertices[i], kNone, certificate->bound[i]));
  double found = 0.0;
  if (certificate->worst != kNone)
    if (const auto pose = find_worst_pose(tree, cracks.rows, certificate->worst))
      found = pose->found;
  findings.add_finding(Code::cert_crack, Severity::note, Evidence::certified,
                       text_of_bracket(found, certificate->maximum) +
                           text_of_gaps(reader, certificate->gaps) +
                           text_of_residuals(reader, *certificate),
                       std::move(places), certificate->maximum);
}

/// The linear part at bind of what moves the term of a bone, of a vertex of the target.
Mat3d matrix_at_bind(std::span<const Influence> influences, std::span<const DrivenSlot> slots,
                     Index bone) {
  Mat3d sum = Mat3d::Zero();
  double weight = 0.0;
  for (const Influence& influence : influences) {
    if (slots[influence.slot].bone != bone) continue;
    sum += static_cast<double>(influence.weight) * slots[influence.slot].model_from_bind.linear();
    weight += static_cast<double>(influence.weight);
  }
  return sum / weight;
}

/// The vertices whose deviation has the largest bounds, as skinned points of their own.
SkinBlends worst_vertices(const RowReader& reader, const CertifiedRows& rows,
                          const ValidationReport& report, std::vector<Index>& vertices) {
  for (Index v = 0; v < report.vertex_bound.size(); ++v)
    if (report.vertex_bound[v] > 0.0f) vertices.push_back(v);
  if (vertices.size() > kMostBlends) {
    std::ranges::nth_element(vertices, vertices.begin() + kMostBlends, [&](Index a, Index b) {
      return std::pair(report.vertex_bound[b], a) < std::pair(report.vertex_bound[a], b);
    });
    vertices.resize(kMostBlends);
    std::ranges::sort(vertices);
  }
  const BindSurface& surface = reader.target().surface;
  SkinBlends blends;
  TermSum sum = rows.points.make_sum();
  for (const Index v : vertices) {
    const Index mesh = surface.mesh_of_vertex(v), vertex = v - surface.first_vertex[mesh];
    rows.points.add_target(mesh, vertex, 1.0, sum);
    sum.finish(blends.points);
    const auto& slots = rows.points.skins().of_target[reader.target().character.meshes[mesh].skin];
    for (std::size_t i = blends.at_bind.size(); i < blends.points.terms.size(); ++i)
      blends.at_bind.push_back(matrix_at_bind(reader.target().influences(mesh, vertex), slots,
                                              blends.points.terms[i].bone));
  }
  return blends;
}

void certify_blends(const RowReader& reader, const JointTree& tree, const CertifiedRows& rows,
                    const ValidationReport& report, FindingList& findings) {
  std::vector<Index> vertices;
  const SkinBlends points = worst_vertices(reader, rows, report, vertices);
  if (vertices.empty()) return findings.add(Code::cert_collapse, {});
  const Result<std::vector<double>> bounds = certify_blend(tree, points);
  if (!bounds) return findings.not_tested(Code::cert_collapse, std::string(bounds.error().text()));
  Places places;
  Index worst = 0;
  for (Index i = 0; i < vertices.size(); ++i) {
    if ((*bounds)[i] < (*bounds)[worst]) worst = i;
    if ((*bounds)[i] <= 0.0)
      places.push_back(reader.target().place(vertices[i], kNone, -(*bounds)[i]));
  }
  if (places.empty()) return findings.add(Code::cert_collapse, {});
  std::string text = std::to_string(places.size()) + " of " + std::to_string(vertices.size()) +
                     " vertices that differ may collapse in some pose within the limits.";
  if (const auto pose = find_collapse_pose(tree, points, worst))
    text += " The smallest singular value found is " + std::to_string(pose->found) + ".";
  findings.add_finding(Code::cert_collapse, Severity::note, Evidence::certified, std::move(text),
                       std::move(places), (*bounds)[worst]);
}

}  // namespace

void check_certificates(const RowReader& reader, const CertifiedRows& rows,
                        const ValidationOptions& options, ValidationReport& report,
                        FindingList& findings) {
  const Result<JointTree> tree = make_tree(reader.source().character, rows.points.bind(), options);
  if (!tree) {
    report.bracket.why = tree.error().text();
    for (const Code code : {Code::cert_deviation, Code::cert_crack, Code::cert_collapse})
      findings.not_tested(code, report.bracket.why);
    return;
  }
  certify_deviations(reader, *tree, rows.differences, report, findings);
  certify_cracks(reader, *tree, rows.cracks, findings);
  certify_blends(reader, *tree, rows, report, findings);
}

}  // namespace sunder::validation
