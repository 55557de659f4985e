#include "tools/picture/labels.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace sunder::tools {
namespace {

/// Lines of each sign on a grid of 5 x 7: pairs of x (to the right) and y (up), polylines separated
/// by spaces.
constexpr std::pair<char, std::string_view> kSigns[] = {{'A', "002640 1232"},
                                                        {'B', "00063645443303 3342413000"},
                                                        {'C', "4536160501103041"},
                                                        {'D', "00063645413000"},
                                                        {'E', "46060040 0333"},
                                                        {'F', "460600 0333"},
                                                        {'G', "45361605011030414323"},
                                                        {'H', "0006 4046 0343"},
                                                        {'I', "1030 2026 1636"},
                                                        {'J', "4641301001"},
                                                        {'K', "0006 460340"},
                                                        {'L', "060040"},
                                                        {'M', "0006234640"},
                                                        {'N', "00064046"},
                                                        {'O', "103041453616050110"},
                                                        {'P', "00063645443303"},
                                                        {'Q', "103041453616050110 2240"},
                                                        {'R', "00063645443303 2340"},
                                                        {'S', "453616050413334241301001"},
                                                        {'T', "0646 2620"},
                                                        {'U', "060110304146"},
                                                        {'V', "062046"},
                                                        {'W', "0610233046"},
                                                        {'X', "0046 0640"},
                                                        {'Y', "062346 2320"},
                                                        {'Z', "06460040"},
                                                        {'0', "103041453616050110 1135"},
                                                        {'1', "152620 1030"},
                                                        {'2', "05163645440040"},
                                                        {'3', "05163645443313 334241301001"},
                                                        {'4', "30360242"},
                                                        {'5', "460603334241301001"},
                                                        {'6', "4536160501103041423303"},
                                                        {'7', "064610"},
                                                        {'8', "13334445361605041302011030414233"},
                                                        {'9', "0110304145361605041343"},
                                                        {'_', "0040"},
                                                        {'-', "1333"},
                                                        {':', "2122 2425"},
                                                        {'.', "2021"},
                                                        {'+', "0343 2125"},
                                                        {'/', "0046"},
                                                        {'|', "2026"},
                                                        {' ', ""}};
constexpr std::string_view kUnknown = "0040460600";

constexpr double kUnit = 1.75;                     ///< Pixels per step of the grid.
constexpr double kAdvance = 6.0;                   ///< Steps from one sign to the next.
constexpr double kHeight = 6.0;                    ///< Steps.
constexpr double kLabelLine = 1.8;                 ///< Width of a line, pixels.
constexpr double kPadding = 3.0, kDistance = 7.0;  ///< Pixels.
const Vec4f kLabelGround(0.93f, 0.94f, 0.95f, 1.0f);

std::string_view lines_of(char sign) {
  const char wanted = static_cast<char>(std::toupper(static_cast<unsigned char>(sign)));
  for (const auto& [known, lines] : kSigns)
    if (known == wanted) return lines;
  return kUnknown;
}

/// @param corner  the lower left one.
void draw_sign(Marks& marks, char sign, const Vec2d& corner, const Vec4f& color) {
  const std::string_view lines = lines_of(sign);
  const double unit = kUnit * marks.viewport().line_scale();
  const auto at = [&](std::size_t i) {
    return Vec2d(corner + unit * Vec2d(lines[i] - '0', '0' - lines[i + 1]));
  };
  for (std::size_t i = 0; i + 3 < lines.size();) {
    if (lines[i + 2] == ' ') {
      i += 3;
      continue;
    }
    marks.line(at(i), at(i + 2), kLabelLine, color);
    i += 2;
  }
}

}  // namespace

bool Labels::place_beside(const Vec2d& pixel, const std::string& text, const Vec4f& color) {
  const auto signs = static_cast<double>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) >> 6) != 2;  // A letter of several bytes is one box.
  }));
  const double scale = marks_.viewport().line_scale();
  const double unit = scale * kUnit, padding = scale * kPadding, distance = scale * kDistance;
  const Vec2d size(unit * (signs * kAdvance - 2) + 2 * padding, unit * kHeight + 2 * padding);
  const std::array<Vec2d, 4> corners = {
      pixel + Vec2d(distance, -size.y() / 2), pixel + Vec2d(-distance - size.x(), -size.y() / 2),
      pixel + Vec2d(-size.x() / 2, -distance - size.y()), pixel + Vec2d(-size.x() / 2, distance)};
  for (const Vec2d& corner : corners) {
    const Box box{corner, corner + size};
    const bool is_free = marks_.viewport().is_inside(box.least) &&
                         marks_.viewport().is_inside(box.greatest) &&
                         std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
                           return (box.least.array() < other.greatest.array()).all() &&
                                  (other.least.array() < box.greatest.array()).all();
                         });
    if (!is_free) continue;
    taken_.push_back(box);
    const Vec2d ground[] = {box.least,
                            {box.greatest.x(), box.least.y()},
                            box.greatest,
                            {box.least.x(), box.greatest.y()}};
    marks_.polygon(ground, kLabelGround);
    Vec2d pen(box.least.x() + padding, box.greatest.y() - padding);
    for (const char sign : text) {
      if ((static_cast<unsigned char>(sign) >> 6) == 2) continue;
      draw_sign(marks_, sign, pen, color);
      pen.x() += unit * kAdvance;
    }
    return true;
  }
  return false;
}

}  // namespace sunder::tools
