#include "io/gltf_patch/pack_bytes.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <vector>

#include "io/gltf_patch/accessor_layout.h"
#include "io/gltf_patch/references.h"

namespace sunder::gltf {
namespace {

constexpr std::uint64_t kDataAlignment = 4, kWholeViewAlignment = 8;

struct Range {
  std::uint64_t begin = 0, end = 0;
};

/// The bytes of a view that are kept; empty if nothing is known of it yet.
struct Kept {
  Range hull;
  bool is_empty = true;
};

class Packing {
 public:
  Packing(GlbDraft& draft, const std::set<std::size_t>& whole_views)
      : draft_(draft),
        whole_views_(whole_views),
        views_(list_in(draft.json, "bufferViews")),
        kept_(views_.size()) {}

  void run() {
    collect_whole_views();
    for (Json& accessor : list_in(draft_.json, "accessors")) collect(accessor);
    find_gaps();
    if (gaps_.empty()) return;
    move_accessors();
    move_views();
    draft_.remove_bytes(gaps_);
  }

 private:
  [[nodiscard]] std::uint64_t offset_of(std::size_t view) const {
    return whole_or(views_[view], "byteOffset", 0);
  }
  [[nodiscard]] std::uint64_t length_of(std::size_t view) const {
    return views_[view]["byteLength"].get<std::uint64_t>();
  }

  void keep(std::size_t view, std::uint64_t begin, std::uint64_t end) {
    const std::uint64_t offset = offset_of(view), size = draft_.bytes().size();
    const Range range{std::min(offset + begin, size), std::min(offset + end, size)};
    ranges_.push_back(range);
    Kept& kept = kept_[view];
    kept.hull.begin = kept.is_empty ? range.begin : std::min(kept.hull.begin, range.begin);
    kept.hull.end = kept.is_empty ? range.end : std::max(kept.hull.end, range.end);
    kept.is_empty = false;
  }

  void collect_whole_views() {
    for (const std::size_t view : whole_views_) keep(view, 0, length_of(view));
    for (const Json& image : list_in(draft_.json, "images"))
      if (image.contains("bufferView")) {
        const auto view = image["bufferView"].get<std::size_t>();
        keep(view, 0, length_of(view));
      }
  }

  void collect(const Json& accessor) {
    const auto count = accessor["count"].get<std::uint64_t>();
    const std::uint64_t element = element_bytes(accessor);
    if (accessor.contains("bufferView"))
      collect(accessor["bufferView"].get<std::size_t>(), accessor, element, count);
    if (!accessor.contains("sparse")) return;
    const Json& sparse = accessor["sparse"];
    const auto sparse_count = sparse["count"].get<std::uint64_t>();
    const Json &indices = sparse["indices"], &values = sparse["values"];
    collect(indices["bufferView"].get<std::size_t>(), indices, component_bytes(indices),
            sparse_count);
    collect(values["bufferView"].get<std::size_t>(), values, element, sparse_count);
  }

  /// Keeps the bytes of `count` elements. Those of a view with a stride begin and end at multiples
  /// of it, because readers such as three.js take whole strides.
  void collect(std::size_t view, const Json& at, std::uint64_t element, std::uint64_t count) {
    const std::uint64_t length = length_of(view),
                        offset = std::min(whole_or(at, "byteOffset", 0), length),
                        given = whole_or(views_[view], "byteStride", 0),
                        stride = given != 0 ? given : element,
                        unit = given != 0 ? given : kDataAlignment;
    const std::uint64_t begin = offset / unit * unit;
    // More elements than the view can hold are a fault, which stays as it is.
    if (count > length / std::max<std::uint64_t>(stride, 1) + 1) return keep(view, begin, length);
    std::uint64_t end = offset + (count - 1) * stride + element;
    if (given != 0) end = std::max(end, begin + count * stride);
    keep(view, begin, std::min(end, length));
  }

  // ---- Gaps

  void find_gaps() {
    std::sort(ranges_.begin(), ranges_.end(),
              [](const Range& a, const Range& b) { return a.begin < b.begin; });
    std::vector<Range> unused;
    std::uint64_t end = 0;
    for (const Range& range : ranges_) {
      if (range.begin > end) unused.push_back({end, range.begin});
      end = std::max(end, range.end);
    }
    const std::uint64_t size = draft_.bytes().size();
    if (end < size) unused.push_back({end, size});
    shorten(unused);
  }

  struct Border {
    std::size_t gap = 0;
    std::uint64_t stride = 0;
    int change = 0;  ///< Of the number of views with this stride whose bytes the gap divides.
  };

  [[nodiscard]] std::vector<Border> borders(const std::vector<Range>& unused) const {
    std::vector<Border> borders;
    for (std::size_t view = 0; view < views_.size(); ++view) {
      const std::uint64_t stride = whole_or(views_[view], "byteStride", 0);
      if (stride == 0 || kept_[view].is_empty) continue;
      const auto first_after = [&](std::uint64_t place) {
        const auto found =
            std::lower_bound(unused.begin(), unused.end(), place,
                             [](const Range& gap, std::uint64_t at) { return gap.begin < at; });
        return static_cast<std::size_t>(found - unused.begin());
      };
      borders.push_back({first_after(kept_[view].hull.begin), stride, 1});
      borders.push_back({first_after(kept_[view].hull.end), stride, -1});
    }
    std::sort(borders.begin(), borders.end(),
              [](const Border& a, const Border& b) { return a.gap < b.gap; });
    return borders;
  }

  /// Removes from each gap a multiple of the alignment, and of the strides of the views that it
  /// divides.
  void shorten(const std::vector<Range>& unused) {
    const std::vector<Border> changes = borders(unused);
    std::map<std::uint64_t, int> views_of_stride;
    auto next = changes.begin();
    std::uint64_t removed = 0;
    for (std::size_t i = 0; i < unused.size(); ++i) {
      for (; next != changes.end() && next->gap <= i; ++next)
        if ((views_of_stride[next->stride] += next->change) == 0)
          views_of_stride.erase(next->stride);
      const std::uint64_t length = unused[i].end - unused[i].begin;
      const bool is_last = unused[i].end == draft_.bytes().size();
      std::uint64_t unit = is_last                ? 1
                           : whole_views_.empty() ? kDataAlignment
                                                  : kWholeViewAlignment;
      for (const auto& [stride, views] : views_of_stride)
        unit = unit > length ? unit : std::lcm(unit, stride);
      const std::uint64_t taken = length / unit * unit;
      if (taken == 0) continue;
      gaps_.push_back({unused[i].end - taken, taken});
      removed += taken;
      removed_.push_back(removed);
    }
  }

  /// Where a byte that is kept will be.
  [[nodiscard]] std::uint64_t moved(std::uint64_t place) const {
    const auto after = std::upper_bound(
        gaps_.begin(), gaps_.end(), place,
        [](std::uint64_t at, const GlbDraft::Gap& gap) { return at < gap.begin + gap.length; });
    const auto count = static_cast<std::size_t>(after - gaps_.begin());
    return count == 0 ? place : place - removed_[count - 1];
  }

  // ---- The document

  static void set(Json& object, const char* name, std::uint64_t value) {
    if (whole_or(object, name, 0) != value) object[name] = value;
  }

  void move_accessors() {
    const auto move = [&](Json& at) {
      const auto view = at["bufferView"].get<std::size_t>();
      const std::uint64_t place = offset_of(view) + whole_or(at, "byteOffset", 0);
      if (place > draft_.bytes().size()) return;
      set(at, "byteOffset", moved(place) - moved(kept_[view].hull.begin));
    };
    for (Json& accessor : list_in(draft_.json, "accessors")) {
      if (accessor.contains("bufferView")) move(accessor);
      if (!accessor.contains("sparse")) continue;
      for (const char* const part : {"indices", "values"}) move(accessor["sparse"][part]);
    }
  }

  void move_views() {
    for (std::size_t view = 0; view < views_.size(); ++view) {
      if (kept_[view].is_empty) continue;
      const auto [begin, end] = kept_[view].hull;
      const std::uint64_t first = moved(begin);
      set(views_[view], "byteOffset", first);
      set(views_[view], "byteLength", begin == end ? 1 : moved(end - 1) + 1 - first);
    }
  }

  GlbDraft& draft_;
  const std::set<std::size_t>& whole_views_;
  std::span<Json> views_;
  std::vector<Kept> kept_;
  std::vector<Range> ranges_;
  std::vector<GlbDraft::Gap> gaps_;
  std::vector<std::uint64_t> removed_;  ///< Per gap: the bytes removed up to its end.
};

}  // namespace

void pack_bytes(GlbDraft& draft, const std::set<std::size_t>& whole_views) {
  Packing(draft, whole_views).run();
}

}  // namespace sunder::gltf
