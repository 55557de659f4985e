#include <string>

#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"
#include "tools/model/model_output.h"
#include "tools/model/robot_joints.h"
#include "tools/written_weights/written_influences.h"

namespace sunder::tools {
namespace {

/// 0 asks for no error at all; above it no influence would be left.
constexpr NumberRange kMaximumError = {.field = "the value", .least = 0, .most = 1e9, .unit = " m"};

/// @param name  a result of weight_format_name().
WeightFormat weight_format(const std::string& name) {
  for (const WeightFormat format : {WeightFormat::unorm16, WeightFormat::unorm8})
    if (name == weight_format_name(format)) return format;
  return WeightFormat::float32;
}

}  // namespace

void add_weights_as(CLI::App& verb, SaveOptions& save) {
  verb.add_option_function<std::string>(
          "--weights-as", [&save](const std::string& name) { save.weights = weight_format(name); },
          "Number format of the written weights; u16 and u8 are normalised integers that sum to "
          "exactly one")
      ->check(CLI::IsMember({"float", "u16", "u8"}))
      ->default_str("float");
}

void check_output_format(const CLI::App& verb, const std::filesystem::path& output) {
  const std::string ending = output.extension().string();
  if (ending == ".usd" || ending == ".usdc")
    throw CLI::ValidationError(
        "--output", output.string() + ": '" + ending +
                        "' is not written; USD is written as text, .usda, or packed, .usdz");
  if (!is_usd(output)) return;
  for (const char* const option : {"--weights-as", "--max-error"})
    if (verb.get_option_no_throw(option) != nullptr && verb.count(option) > 0)
      throw CLI::ValidationError(
          option, "is for GLB: USD stores weights as floats; --output is " + output.string());
}

void add_maximum_error(CLI::App& verb, std::optional<MaximumError>& wanted,
                       std::optional<std::filesystem::path>* robot_limits) {
  CLI::Option* const length =
      verb.add_option_function<std::string>(
              "--max-error",
              [&wanted](const std::string& text) {
                const std::optional<double> metres = length_with_unit(text);
                if (!metres)
                  throw CLI::ValidationError("--max-error",
                                             "'" + text +
                                                 "' is no length; expected a number and its unit: "
                                                 "0.1mm, 20um, 1cm, 0.02m");
                check_value("--max-error", kMaximumError, *metres);
                wanted = MaximumError{*metres};
              },
              "Write as few influences and bits as keep every vertex within this distance of the "
              "unpruned skin in every pose: 0.1mm, 20um, 1cm")
          ->type_name("LENGTH");
  for (const char* const other : {"--influences", "--weights-as"})
    length->excludes(verb.get_option(other));
  verb.add_option_function<std::string>(
          "--limits",
          [&wanted, robot_limits](const std::string& limits) {
            if (wanted) wanted->limits = limits;
            const bool is_for_fits = robot_limits != nullptr && is_urdf(limits);
            if (is_for_fits) *robot_limits = limits;
            if (!wanted && !is_for_fits) throw CLI::RequiresError("--limits", "--max-error");
          },
          "Joint limits for --max-error: none, clips, or a JSON or URDF file")
      ->type_name("none|clips|FILE")
      ->default_str("none");
}

}  // namespace sunder::tools
