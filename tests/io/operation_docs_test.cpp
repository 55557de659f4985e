// The documentation of operation logs follows the descriptions of the operations.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/described_fields.h"
#include "io/operation_schema.h"

namespace sunder::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string text_of_file(const char* name) {
  std::ifstream file(std::filesystem::path(SUNDER_SOURCE_DIR) / "docs" / name);
  return {std::istreambuf_iterator<char>(file), {}};
}

using Row = std::vector<std::string>;

/// The cells of a row of a table; "\|" is no border.
Row cells_of(const std::string& line) {
  Row cells;
  std::string cell;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] != '|' || line[i - 1] == '\\') {
      cell += line[i];
      continue;
    }
    const std::size_t begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
    cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
    cell.clear();
  }
  return cells;
}

/// The rows of the tables of a page whose header is `header`, without those of headers.
std::vector<Row> rows_below(const std::string& page, const std::string& section,
                            const std::string& header) {
  std::vector<Row> rows;
  std::istringstream lines(page.substr(page.find(section)));
  std::string line;
  while (std::getline(lines, line) && !line.starts_with(header)) {
  }
  while (std::getline(lines, line) && line.starts_with("|"))
    if (!line.starts_with("|---")) rows.push_back(cells_of(line));
  return rows;
}

/// The words between back quotes.
std::set<std::string> quoted(const std::string& cell) {
  std::set<std::string> words;
  for (std::size_t begin = cell.find('`'); begin != std::string::npos;) {
    const std::size_t end = cell.find('`', begin + 1);
    words.insert(cell.substr(begin + 1, end - begin - 1));
    begin = cell.find('`', end + 1);
  }
  return words;
}

/// The last cell of a field: what it is if it is left out.
std::string default_text(const DescribedField& of) {
  if (of.field.use == Use::required) return "required";
  if (of.field.otherwise != nullptr) return of.field.otherwise;
  const auto& value = of.value_if_left_out;
  if (value.is_object() && value.contains("widths")) return value["widths"].dump() + " widths";
  if (!value.is_number()) return "`" + value.dump() + "`";
  std::ostringstream number;
  number << value.get<double>();
  return number.str();
}

struct Table {
  const char* name;
  const char* section;
  const char* header;
  std::vector<DescribedField> fields;
};

class OperationDocs : public testing::TestWithParam<Table> {};

TEST_P(OperationDocs, HaveARowPerField) {
  const Table& table = GetParam();
  const auto rows = rows_below(text_of_file("operation_log.md"), table.section, table.header);
  std::map<std::string, Row> by_name;
  for (const Row& row : rows) by_name[row.at(0)] = row;
  by_name.erase("`op`");
  for (const DescribedField& of : table.fields) {
    const std::string name = "`" + std::string(of.field.name) + "`";
    ASSERT_TRUE(by_name.contains(name)) << name;
    EXPECT_THAT(by_name[name].at(1), StartsWith(of.field.text)) << name;
    EXPECT_EQ(by_name[name].at(2), default_text(of)) << name;
  }
  EXPECT_EQ(by_name.size(), table.fields.size());
}

constexpr const char* kFields = "| field | | default |";
INSTANTIATE_TEST_SUITE_P(
    Tables, OperationDocs,
    testing::Values(
        Table{"Tear", "\n## `tear`\n", kFields, described_fields<TearOperation>()},
        Table{"Cut", "\n## `cut`\n", kFields, described_fields<CutOperation>()},
        Table{"Drill", "\n## `drill`\n", kFields, described_fields<DrillOperation>()},
        Table{"Weld", "\n## `weld`\n", kFields, described_fields<WeldOperation>()},
        Table{"Suture", "\n## `suture`\n", kFields, described_fields<SutureOperation>()},
        Table{"Detach", "\n## `detach`\n", kFields, described_fields<DetachOperation>()},
        Table{"Weights", "\n## `weights`\n", kFields, described_fields<WeightsOperation>()},
        Table{"WeightOptions", "\n## `weights`\n", "| field of `weights`",
              described_fields<WeightOptions>()},
        Table{"Refit", "\n## `weights`\n", "| field of `refit` |",
              described_fields<RefitOptions>()},
        Table{"PoseSet", "\n## `weights`\n", "| field of `refit.poses`",
              described_fields<PoseSetSpec>()}),
    [](const auto& test) { return std::string(test.param.name); });

/// The fields of aimed operations by the names of the operations that have them.
template <class... Kinds>
std::map<std::string, std::vector<DescribedField>> aimed_fields(const std::variant<Kinds...>*) {
  return {{kOpName<Kinds>, described_fields<Kinds>()}...};
}

/// One table has the fields of all aimed operations: names, operations, text, default.
TEST(OperationDocs, HaveTheFieldsOfAimedOperations) {
  const auto page = text_of_file("operation_log.md");
  const auto aimed = aimed_fields(static_cast<const AimedOperation*>(nullptr));
  std::set<std::string> tear_fields, seen, described;
  for (const DescribedField& of : described_fields<TearOperation>())
    tear_fields.insert(of.field.name);
  for (const Row& row : rows_below(page, "\n## Aimed operations\n", "| field | of |"))
    for (const auto& [op, fields] : aimed)
      for (const DescribedField& of : fields) {
        if (!quoted(row.at(0)).contains(of.field.name)) continue;
        if (row.at(1) != "all" && !quoted(row.at(1)).contains(op)) continue;
        EXPECT_TRUE(seen.insert(op + "." + of.field.name).second) << op << of.field.name;
        const bool is_as_in_tear = row.at(2).starts_with("As in `tear`");
        EXPECT_TRUE(!is_as_in_tear || tear_fields.contains(of.field.name)) << of.field.name;
        if (!is_as_in_tear) {
          EXPECT_THAT(row.at(2), StartsWith(of.field.text));
        }
        if (row.at(3) != "as there") {
          EXPECT_THAT(row.at(3), HasSubstr(default_text(of)));
        }
      }
  for (const auto& [op, fields] : aimed)
    for (const DescribedField& of : fields) described.insert(op + "." + of.field.name);
  EXPECT_EQ(seen, described);
}

/// The ranges of numbers, as the page writes them.
struct RangeTexts {
  std::map<std::string, std::string>& by_field;

  static std::string number(double value) {
    std::ostringstream text;
    text << value;
    return std::regex_replace(text.str(), std::regex("e\\+?(-?)0*"), "e$1");
  }
  static std::string text_of(const NumberRange& range) {
    if (range.least == -range.most) return "±" + number(range.most);
    return (range.is_above_least ? "above " + number(range.least) + ", at most "
                                 : number(range.least) + " to ") +
           number(range.most) + range.unit;
  }
  void operator()(const Field& field, const auto&, const NumberRange& range) const {
    by_field[field.name] = text_of(range);
  }
  void operator()(const Field& field, double, const Degrees& kind) const {
    by_field[field.name] = text_of(kind.range);
  }
  template <class Widths>
  void operator()(const Field& field, double, const TearLength<Widths>& kind) const {
    by_field[field.name] = text_of(kind.range);
  }
  void operator()(const Field&, const auto&...) const {}
  void object(const Field&, const auto&) const {}
};

TEST(OperationDocs, HaveTheRanges) {
  std::map<std::string, std::string> texts;
  const RangeTexts collector{texts};
  const auto collect = [&](const auto&... described) { (describe(collector, described), ...); };
  // A puncture's chord tolerance has the range of a bore's when its radius is known.
  collect(PunctureOperation{});
  texts["chord_tolerance"] = RangeTexts::text_of(field::chord_tolerance(1)) + " of the radius";
  texts["chord_tolerance"].replace(texts["chord_tolerance"].find(" m"), 2, "");
  collect(SlashOperation{}, SeverOperation{}, IncisionOperation{}, TearOptions{}, RefitOptions{},
          ClipPose{});
  EXPECT_GT(texts.size(), 10u);
  for (const Row& row :
       rows_below(text_of_file("operation_log.md"), "\n## Ranges\n", "| field | range |"))
    for (const std::string& name : quoted(row.at(0))) {
      EXPECT_THAT(row.at(1), HasSubstr(texts[name])) << name;
      texts.erase(name);
    }
  for (const auto& [name, text] : texts) ADD_FAILURE() << name << " has no row: " << text;
}

/// Print it anew with the program operation_log_schema.
TEST(OperationDocs, TheSchemaIsTheOneThatTheDescriptionsGive) {
  EXPECT_EQ(text_of_file("operation_log.schema.json"), operation_schema());
}

TEST(OperationDocs, NameEnumerators) {
  const auto page = text_of_file("operation_log.md");
  const auto expect_all = [&](const auto& names) {
    for (const char* const name : names)
      EXPECT_THAT(page, HasSubstr("`\"" + std::string(name) + "\"`"));
  };
  expect_all(kNames<Layers>);
  expect_all(kNames<WeightPolicy>);
}

/// The members of a struct that its description names, with the padding between them, fill it.
struct Members {
  std::map<const std::byte*, std::pair<std::size_t, std::size_t>> by_place;  ///< Size, alignment.

  template <class T>
  void add(const T& member) {
    by_place[reinterpret_cast<const std::byte*>(&member)] = {sizeof(T), alignof(T)};
  }
  void operator()(const Field&, const auto& member, const auto&...) { add(member); }
  template <class PoseChanges>
  void operator()(const Field&, const Stroke& stroke, const Blades<PoseChanges>& kind) {
    add(stroke);
    add(*kind.pose_changes);
  }
  template <class Widths>
  void operator()(const Field&, const double& length, const TearLength<Widths>& kind) {
    add(length);
    if (kind.in_widths != nullptr) add(*kind.in_widths);
  }
  void object(const Field&, const auto& body) { body(*this); }
};

template <class T>
class DescribedMembers : public testing::Test {};
using DescribedStructs =
    testing::Types<TearOptions, PlaneCut, Bore, SectionRay, Blade, WeightOptions, WeightsOperation,
                   RefitOptions, RefitImportance, RefitImportance::OfClip, PoseSetSpec, JointLimit,
                   ClipPose, TearOperation, CutOperation, DrillOperation, Weld, WeldOperation,
                   Suture, SutureOperation, DetachOperation, PieceOfTriangle, PieceNear,
                   UndoOperation, RedoOperation, SlashOperation, SeverOperation, PunctureOperation,
                   IncisionOperation, SurfacePlace>;
TYPED_TEST_SUITE(DescribedMembers, DescribedStructs);

TYPED_TEST(DescribedMembers, AreAllMembers) {
  const TypeParam of{};
  Members members;
  describe(members, of);
  const auto* const begin = reinterpret_cast<const std::byte*>(&of);
  const auto aligned = [](std::size_t offset, std::size_t to) {
    return (offset + to - 1) / to * to;
  };
  std::size_t end = 0;
  for (const auto& [place, size] : members.by_place) {
    const auto offset = static_cast<std::size_t>(place - begin);
    EXPECT_EQ(offset, aligned(end, size.second))
        << "a member before the byte " << offset << " has no description";
    end = offset + size.first;
  }
  EXPECT_EQ(aligned(end, alignof(TypeParam)), sizeof(TypeParam));
}

}  // namespace
}  // namespace sunder::test
