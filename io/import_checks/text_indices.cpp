#include "io/import_checks/text_indices.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

namespace sunder::assimp_import {
namespace {

class Lines {
 public:
  explicit Lines(const std::string& text) : stream_(text) {}

  /// The next line that is not blank.
  bool next(std::string& line) {
    while (std::getline(stream_, line)) {
      std::replace(line.begin(), line.end(), '\r', ' ');
      if (line.find_first_not_of(" \t") != std::string::npos) return true;
    }
    return false;
  }

 private:
  std::istringstream stream_;
};

/// The whole numbers at the beginning of a text, at most 16.
std::vector<long long> numbers_of(const std::string& text) {
  std::vector<long long> numbers;
  for (const char* at = text.c_str(); numbers.size() < 16;) {
    char* end = nullptr;
    const long long number = std::strtoll(at, &end, 10);
    if (end == at) break;
    numbers.push_back(number);
    at = end;
  }
  return numbers;
}

/// Numbers of vertices and faces; fewer if the header has none.
std::vector<long long> off_counts(Lines& lines) {
  std::vector<long long> counts;
  for (std::string line; counts.size() < 2 && lines.next(line);) {
    line.resize(std::min(line.size(), line.find('#')));
    if (const std::size_t name = line.find("OFF"); name != std::string::npos)
      line.erase(0, name + 3);
    for (const long long number : numbers_of(line)) counts.push_back(number);
  }
  return counts;
}

TextIndices read_off(Lines lines) {
  TextIndices found;
  found.faces.resize(1);
  const std::vector<long long> counts = off_counts(lines);
  if (counts.size() < 2) return found;
  std::string line;
  for (long long vertex = 0; vertex < counts[0]; ++vertex)
    if (!lines.next(line)) return found;
  std::uint32_t ordinal = 0;
  for (long long face = 0; face < counts[1] && lines.next(line); ++face) {
    const std::vector<long long> numbers = numbers_of(line);
    const long long corners = numbers.empty() ? 0 : numbers[0];
    if (corners < 1 || corners > 9) continue;  // assimp leaves it out.
    for (std::size_t i = 1; i < numbers.size() && i <= static_cast<std::size_t>(corners); ++i)
      if (numbers[i] < 0 || numbers[i] >= counts[0]) found.faces[0].insert(ordinal);
    ++ordinal;
  }
  return found;
}

/// Whether an index of an OBJ file, from 1 on or from -1 backwards, names one of the entries so
/// far.
bool exists(long long index, long long count) {
  return index > 0 ? index <= count : index < 0 && -index <= count;
}

TextIndices read_obj(Lines lines) {
  TextIndices found;
  long long normals = 0, coordinates = 0;
  for (std::string line; lines.next(line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    normals += word == "vn";
    coordinates += word == "vt";
    if (word != "f") continue;
    while (words >> word) {
      const std::size_t first = word.find('/');
      if (first == std::string::npos) continue;
      const std::size_t second = word.find('/', first + 1);
      const std::string middle = word.substr(first + 1, second - first - 1);
      if (!middle.empty() && !exists(std::atoll(middle.c_str()), coordinates)) ++found.coordinates;
      if (second != std::string::npos && second + 1 < word.size() &&
          !exists(std::atoll(word.c_str() + second + 1), normals))
        ++found.normals;
    }
  }
  return found;
}

TextIndices read_md5(Lines lines) {
  struct Mesh {
    long long vertices = 0;
    bool has_triangles = false;
    std::set<std::uint32_t> faces;
  };
  std::vector<Mesh> meshes;
  for (std::string line; lines.next(line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "mesh") meshes.emplace_back();
    if (meshes.empty()) continue;
    Mesh& mesh = meshes.back();
    if (word == "numverts") words >> mesh.vertices;
    if (word != "tri") continue;
    mesh.has_triangles = true;
    std::uint32_t face = 0;
    words >> face;
    for (long long index = 0; words >> index;)
      if (index < 0 || index >= mesh.vertices) mesh.faces.insert(face);
  }
  TextIndices found;
  for (Mesh& mesh : meshes)  // assimp makes no mesh of the others.
    if (mesh.vertices > 0 && mesh.has_triangles) found.faces.push_back(std::move(mesh.faces));
  return found;
}

/// The numbers of a text from a place on, whatever separates them.
class Numbers {
 public:
  Numbers(const std::string& text, std::size_t at) : at_(text.c_str() + at) {}

  /// Zero at the end of the text, or of its numbers.
  double next() {
    while (*at_ == ';' || *at_ == ',' || std::isspace(static_cast<unsigned char>(*at_)) != 0) ++at_;
    char* end = nullptr;
    const double number = std::strtod(at_, &end);
    has_ended_ |= end == at_;
    at_ = end;
    return has_ended_ ? 0.0 : number;
  }
  [[nodiscard]] bool has_ended() const { return has_ended_; }

 private:
  const char* at_;
  bool has_ended_ = false;
};

/// MeshNormals { number of normals; normals; number of faces; corners; indices … }
TextIndices read_x(const std::string& text) {
  TextIndices found;
  if (text.compare(0, 4, "xof ") != 0 || text.compare(8, 3, "txt") != 0) return found;
  constexpr std::string_view kName = "MeshNormals";
  for (std::size_t at = text.find(kName); at != std::string::npos; at = text.find(kName, at + 1)) {
    const std::size_t begin = text.find('{', at);
    if (begin == std::string::npos) break;
    Numbers numbers(text, begin + 1);
    const double normals = numbers.next();
    for (double i = 0; i < 3 * normals && !numbers.has_ended(); ++i) numbers.next();
    const double faces = numbers.next();
    for (double face = 0; face < faces && !numbers.has_ended(); ++face)
      for (double corners = numbers.next(); corners > 0 && !numbers.has_ended(); --corners)
        if (const double index = numbers.next();
            !numbers.has_ended() && (index < 0 || index >= normals))
          ++found.normals;
  }
  found.is_dangerous = found.normals > 0;
  return found;
}

}  // namespace

bool has_text_indices(const Format& format) {
  return format.extension == "off" || format.extension == "obj" || format.extension == "md5mesh" ||
         format.extension == "x";
}

TextIndices read_text_indices(const Format& format, const std::string& text) {
  if (format.extension == "off") return read_off(Lines(text));
  if (format.extension == "obj") return read_obj(Lines(text));
  if (format.extension == "md5mesh") return read_md5(Lines(text));
  if (format.extension == "x") return read_x(text);
  return {};
}

}  // namespace sunder::assimp_import
