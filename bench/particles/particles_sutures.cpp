#include "bench/particles/particles_sutures.h"

#include "support/oracles/membrane.h"

namespace sunder::bench {
namespace {

SutureFigures measure_suture(double range, double spacing, double stiffness) {
  constexpr std::uint32_t kOrders = 3;
  constexpr double kPull = 1.2;
  SutureFigures figures{range, spacing, stiffness};
  for (std::uint32_t order = 0; order < kOrders; ++order) {
    test::SlitSheet sheet(160, 0.3, range, {}, 1, order);
    sheet.open(kPull);
    const double open = gap_of(sheet).widest();
    Suture suture;
    suture.spacing = spacing;
    suture.stiffness = stiffness;
    sheet.sew(suture);
    sheet.open(kPull);
    const double found = widest_between_threads(sheet, gap_of(sheet)),
                 wanted = widest_between_threads(sheet, reference_gap(sheet, kPull, 0.5 * range));
    figures.sewn += found / open / kOrders;
    figures.error += (found / wanted - 1) / kOrders;
  }
  return figures;
}

}  // namespace

std::vector<SutureFigures> measure_sutures() {
  std::vector<SutureFigures> figures;
  for (const double range : {0.1, 0.05})
    for (const double spacing : {0.1, 0.15, 0.2, 0.3})
      for (const double stiffness : {0.3, 3.0, 3e3})
        if (spacing > 1.4 * range) figures.push_back(measure_suture(range, spacing, stiffness));
  return figures;
}

}  // namespace sunder::bench
