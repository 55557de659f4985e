#include "bench/weights/weights_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bench/harness/measure.h"
#include "bench/weights/weights_output.h"

namespace sunder::bench {
namespace {

constexpr double kWidth = 800, kHeight = 520;
constexpr double kLeft = 76, kRight = 620, kTop = 24, kBottom = 456;

/// Powers of ten along an axis.
struct LogAxis {
  int first = 0, last = 1;  ///< Exponents.
  double begin = 0, end = 0;

  static LogAxis around(const std::vector<double>& values, double begin, double end) {
    const auto [least, largest] = std::minmax_element(values.begin(), values.end());
    const int first = static_cast<int>(std::floor(std::log10(*least)));
    return {first, std::max(first + 1, static_cast<int>(std::ceil(std::log10(*largest)))), begin,
            end};
  }
  [[nodiscard]] double at(double value) const {
    return begin + (end - begin) * (std::log10(value) - first) / (last - first);
  }
};

/// Colours of Okabe and Ito, which can be told apart with colour vision deficiencies.
const char* colour_of(WeightPolicy policy) {
  switch (policy) {
    case WeightPolicy::barycentric: return "#000000";
    case WeightPolicy::pose_exact: return "#0072B2";
    case WeightPolicy::refit: return "#D55E00";
    default: return "#009E73";
  }
}

/// Disc: 4, square: 8, triangle: all.
void draw_mark(std::FILE* out, double x, double y, double size, const WeightOptions& options,
               bool is_median) {
  const char* colour = colour_of(options.policy);
  const char* look = is_median ? "stroke=\"#ffffff\" stroke-width=\"1.5\"" : "fill-opacity=\"0.3\"";
  if (options.maximum_influences == 4)
    std::fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\" %s/>\n", x, y, size,
                 colour, look);
  else if (options.maximum_influences == 8)
    std::fprintf(out,
                 "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\" %s/>\n",
                 x - 0.9 * size, y - 0.9 * size, 1.8 * size, 1.8 * size, colour, look);
  else
    std::fprintf(out, "<path d=\"M%.1f %.1fl%.1f %.1fh%.1fz\" fill=\"%s\" %s/>\n", x,
                 y - 1.2 * size, 1.2 * size, 2.1 * size, -2.4 * size, colour, look);
}

/// Size of the mark of the median. It falls with K, so that coinciding marks are all visible.
double median_size(std::uint32_t maximum) { return maximum == 4 ? 9.5 : maximum == 8 ? 7.5 : 5.5; }

void draw_text(std::FILE* out, double x, double y, const char* anchor, const std::string& text,
               const char* more = "") {
  std::fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>%s</text>\n", x, y, anchor,
               more, text.c_str());
}

/// 0.001 to 1000 in full, others as powers.
std::string power_of_ten(int exponent) {
  char text[96];
  if (exponent < -3 || exponent > 3)
    std::snprintf(text, sizeof text, "10<tspan dy=\"-5\" font-size=\"10\">%s%d</tspan>",
                  exponent < 0 ? "−" : "", std::abs(exponent));
  else
    std::snprintf(text, sizeof text, "%.*f", std::max(0, -exponent), std::pow(10, exponent));
  return text;
}

void draw_axes(std::FILE* out, const LogAxis& time, const LogAxis& error) {
  for (int e = time.first; e <= time.last; ++e) {
    const double x = time.at(std::pow(10, e));
    std::fprintf(out, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#dddddd\"/>\n", x, kTop, kBottom);
    draw_text(out, x, kBottom + 20, "middle", power_of_ten(e));
  }
  for (int e = error.first; e <= error.last; ++e) {
    const double y = error.at(std::pow(10, e));
    std::fprintf(out, "<path d=\"M%.1f %.1fH%.1f\" stroke=\"#dddddd\"/>\n", kLeft, y, kRight);
    draw_text(out, kLeft - 8, y + 4, "end", power_of_ten(e));
  }
  std::fprintf(out, "<path d=\"M%.1f %.1fV%.1fH%.1f\" fill=\"none\" stroke=\"#444444\"/>\n", kLeft,
               kTop, kBottom, kRight);
  draw_text(out, 0.5 * (kLeft + kRight), kBottom + 46, "middle", "time a new point, µs");
  const double middle = 0.5 * (kTop + kBottom);
  char turned[64];
  std::snprintf(turned, sizeof turned, " transform=\"rotate(-90 20 %.1f)\"", middle);
  draw_text(out, 20, middle, "middle", "RMS error in poses held out, % of the diagonal", turned);
}

void draw_legend(std::FILE* out) {
  const double x = kRight + 34;
  double y = kTop + 12;
  draw_text(out, x - 10, y, "start", "policy", " font-weight=\"bold\"");
  for (const WeightPolicy policy : {WeightPolicy::barycentric, WeightPolicy::pose_exact,
                                    WeightPolicy::refit, WeightPolicy::exact}) {
    y += 24;
    std::fprintf(out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"14\" fill=\"%s\"/>\n",
                 x - 7, y - 11, colour_of(policy));
    draw_text(out, x + 18, y, "start", weight_policy_name(policy));
  }
  y += 40;
  draw_text(out, x - 10, y, "start", "influences, at most", " font-weight=\"bold\"");
  for (const auto& [maximum, name] :
       {std::pair(4u, "4"), std::pair(8u, "8"), std::pair(0u, "all")}) {
    y += 24;
    draw_mark(out, x, y - 4, median_size(maximum), {WeightPolicy::barycentric, maximum}, true);
    draw_text(out, x + 18, y, "start", name);
  }
  y += 40;
  draw_mark(out, x, y - 4, median_size(4), {WeightPolicy::barycentric, 4}, true);
  draw_text(out, x + 18, y, "start", "median of models");
  y += 24;
  draw_mark(out, x, y - 4, 4, {WeightPolicy::barycentric, 4}, false);
  draw_text(out, x + 18, y, "start", "a model");
}

double error_of(const PolicyRow& row) {
  return 100 * (row.errors.clips ? row.errors.clips->held_out.rms
                                 : row.errors.range_of_motion.held_out.rms);
}

}  // namespace

bool write_weights_picture(const std::vector<ModelFigures>& models, const char* file) {
  std::vector<double> times, errors;
  for (const ModelFigures& model : models)
    for (const PolicyRow& row : model.rows) {
      times.push_back(row.microseconds);
      if (error_of(row) > 0) errors.push_back(error_of(row));
    }
  if (errors.empty()) return false;
  std::FILE* out = std::fopen(file, "w");
  if (out == nullptr) return false;
  const LogAxis time = LogAxis::around(times, kLeft, kRight),
                error = LogAxis::around(errors, kBottom, kTop);
  const double least = std::pow(10, error.first);
  std::fprintf(out,
               "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
               "viewBox=\"0 0 %.0f %.0f\" "
               "font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"13\" fill=\"#222222\">\n"
               "<rect width=\"%.0f\" height=\"%.0f\" fill=\"#ffffff\"/>\n",
               kWidth, kHeight, kWidth, kHeight, kWidth, kHeight);
  draw_axes(out, time, error);
  for (const ModelFigures& model : models)
    for (const PolicyRow& row : model.rows)
      draw_mark(out, time.at(row.microseconds), error.at(std::max(error_of(row), least)), 4,
                row.options, false);
  for (std::size_t i = 0; i < models.front().rows.size(); ++i) {
    std::vector<double> times_of_row, errors_of_row;
    for (const ModelFigures& model : models) {
      times_of_row.push_back(model.rows[i].microseconds);
      errors_of_row.push_back(std::max(error_of(model.rows[i]), least));
    }
    const WeightOptions& options = models.front().rows[i].options;
    draw_mark(out, time.at(median(times_of_row)), error.at(median(errors_of_row)),
              median_size(options.maximum_influences), options, true);
  }
  draw_legend(out);
  std::fprintf(out, "</svg>\n");
  return std::fclose(out) == 0;
}

}  // namespace sunder::bench
