#include "tear/bodies/qhull.h"

#include <cstdio>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace sunder::bodies {
namespace {

/// One run of Qhull, whose memory is freed at the end.
class Run {
 public:
  /// Qhull cannot do without a file for its messages; its texts are of no use to a caller.
  Run() : messages_(std::fopen("/dev/null", "w")) {
    if (messages_ == nullptr) messages_ = std::tmpfile();
    qh_zero(&qh_, messages_ != nullptr ? messages_ : stderr);
  }
  ~Run() {
    int unfreed_bytes = 0, unfreed_pieces = 0;
    qh_freeqhull(&qh_, !qh_ALL);
    qh_memfreeshort(&qh_, &unfreed_bytes, &unfreed_pieces);
    if (messages_ != nullptr) std::fclose(messages_);
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// Qt: faces with more corners are triangulated.
  [[nodiscard]] bool compute(std::vector<double>& coordinates) {
    char options[] = "qhull Qt Pp";
    return qh_new_qhull(&qh_, 3, static_cast<int>(coordinates.size() / 3), coordinates.data(),
                        False, options, nullptr, qh_.ferr) == 0;
  }

  [[nodiscard]] std::vector<Triangle> faces() {
    std::vector<Triangle> triangles;
    const qhT* const qh = &qh_;  // a name that Qhull's macros expect
    facetT* facet = nullptr;
    FORALLfacets {
      Triangle triangle = {};
      std::size_t count = 0;
      vertexT *vertex = nullptr, **vertexp = nullptr;
      FOREACHvertex_(facet->vertices) {
        if (count < 3)
          triangle[count] = static_cast<std::uint32_t>(qh_pointid(&qh_, vertex->point));
        ++count;
      }
      if (count == 3) triangles.push_back(triangle);
    }
    return triangles;
  }

 private:
  qhT qh_ = {};
  std::FILE* messages_;
};

}  // namespace

bool has_qhull() { return true; }

std::vector<Triangle> hull_faces(std::span<const Vec3d> points) {
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const Vec3d& point : points)
    coordinates.insert(coordinates.end(), point.data(), point.data() + 3);
  Run run;
  return run.compute(coordinates) ? run.faces() : std::vector<Triangle>();
}

}  // namespace sunder::bodies
