#include "bench/harness/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

namespace sunder::bench {
namespace {

constexpr double kWidth = 640, kHeight = 400, kLeft = 60, kRight = 170, kTop = 36, kBottom = 48;
constexpr std::array kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000"};

/// A logarithmic axis: whole decades, below them one for zeros.
class Axis {
 public:
  Axis(double begin, double end) : begin_(begin), end_(end) {}

  void add(double value) {
    if (!(value > 0)) {
      has_zero_ = true;
      return;
    }
    const double decade = std::log10(value);
    low_ = std::min(low_, std::floor(decade));
    high_ = std::max(high_, std::ceil(decade));
  }
  [[nodiscard]] double place(double value) const {
    const double decade = value > 0 ? std::log10(value) : lowest();
    const double part = (decade - lowest()) / std::max(1.0, high_ - lowest());
    return begin_ + part * (end_ - begin_);
  }
  /// Calls visit(value) for each mark: every decade, or every few of many.
  template <class Visit>
  void for_each_mark(Visit visit) const {
    if (has_zero_) visit(0.0);
    const double stride = std::ceil((high_ - low_) / 8);
    for (double decade = low_; decade <= high_; decade += std::max(1.0, stride))
      visit(std::pow(10.0, decade));
  }

 private:
  [[nodiscard]] double lowest() const { return has_zero_ ? low_ - 1 : low_; }

  double begin_, end_;
  double low_ = 1e3, high_ = -1e3;
  bool has_zero_ = false;
};

std::string label_of(double value) {
  if (value == 0) return "0";
  const int decade = static_cast<int>(std::lround(std::log10(value)));
  if (decade >= 0 && decade <= 3) return std::to_string(std::lround(value));
  return "1e" + std::to_string(decade);
}

void write_text(std::ofstream& out, double x, double y, const char* anchor, const std::string& text,
                const char* color = "#333333") {
  out << "<text x='" << x << "' y='" << y << "' text-anchor='" << anchor << "' fill='" << color
      << "'>" << text << "</text>\n";
}

void write_grid(std::ofstream& out, const Axis& x, const Axis& y) {
  const auto line = [&](double x1, double y1, double x2, double y2) {
    out << "<line x1='" << x1 << "' y1='" << y1 << "' x2='" << x2 << "' y2='" << y2
        << "' stroke='#dddddd'/>\n";
  };
  x.for_each_mark([&](double value) {
    line(x.place(value), kTop, x.place(value), kHeight - kBottom);
    write_text(out, x.place(value), kHeight - kBottom + 16, "middle", label_of(value));
  });
  y.for_each_mark([&](double value) {
    line(kLeft, y.place(value), kWidth - kRight, y.place(value));
    write_text(out, kLeft - 6, y.place(value) + 4, "end", label_of(value));
  });
}

}  // namespace

bool write_svg(const Plot& plot, const std::filesystem::path& file) {
  std::ofstream out(file);
  Axis x(kLeft, kWidth - kRight), y(kHeight - kBottom, kTop);
  for (const double value : plot.x) x.add(value);
  for (const PlotSeries& series : plot.series)
    for (const double value : series.values) y.add(value);
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << kWidth << ' ' << kHeight
      << "' font-family='sans-serif' font-size='12'>\n<rect width='" << kWidth << "' height='"
      << kHeight << "' fill='white'/>\n";
  write_text(out, kLeft, 20, "start", plot.title, "#000000");
  write_grid(out, x, y);
  write_text(out, 0.5 * (kLeft + kWidth - kRight), kHeight - 10, "middle", plot.of_x);
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const PlotSeries& series = plot.series[s];
    const char* const color = kColors[s % kColors.size()];
    out << "<polyline fill='none' stroke-width='2' stroke='" << color << "' points='";
    for (std::size_t i = 0; i < plot.x.size(); ++i)
      out << x.place(plot.x[i]) << ',' << y.place(series.values[i]) << ' ';
    out << "'/>\n";
    for (std::size_t i = 0; i < plot.x.size(); ++i)
      out << "<circle r='3' cx='" << x.place(plot.x[i]) << "' cy='" << y.place(series.values[i])
          << "' fill='" << color << "'/>\n";
    write_text(out, kWidth - kRight + 12, kTop + 18 * static_cast<double>(s + 1), "start",
               series.name, color);
  }
  out << "</svg>\n";
  return out.good();
}

}  // namespace sunder::bench
