#include "tools/command_line/manual.h"

#include <sstream>

namespace sunder::tools {
namespace {

/// Text without meaning to roff, except that `code` becomes bold.
std::string escaped_for_roff(const std::string& text) {
  std::string result;
  bool is_code = false, is_line_begin = true;
  for (const char letter : text) {
    if (is_line_begin && (letter == '.' || letter == '\'')) result += "\\&";
    is_line_begin = letter == '\n';
    if (letter == '`') {
      is_code = !is_code;
      result += is_code ? "\\fB" : "\\fR";
    } else if (letter == '\\') {
      result += "\\e";
    } else if (letter == '-') {
      result += "\\-";
    } else {
      result += letter;
    }
  }
  return result;
}

/// Paragraphs of text; lines that are indented stay as they are.
std::string paragraphs(const std::string& text) {
  std::string result;
  std::istringstream lines(text);
  bool is_literal = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_indented = line.starts_with("  ");
    if (is_indented != is_literal) result += is_indented ? ".nf\n" : ".fi\n";
    is_literal = is_indented;
    result += line.empty() ? ".PP\n" : escaped_for_roff(line) + "\n";
  }
  return is_literal ? result + ".fi\n" : result;
}

std::string option_entry(const ListedOption& option) {
  std::string entry = ".TP\n";
  for (std::size_t i = 0; i < option.names.size(); ++i)
    entry += (i > 0 ? ", \\fB" : "\\fB") + escaped_for_roff(option.names[i]) + "\\fR";
  const bool is_positional = !option.names.front().starts_with('-');
  if (!option.value.empty() && !is_positional)
    entry += " \\fI" + escaped_for_roff(option.value) + "\\fR";
  entry += '\n' + escaped_for_roff(option.text);
  if (!option.default_text.empty())
    entry += " (default: " + escaped_for_roff(option.default_text) + ")";
  return entry + '\n';
}

std::string verb_section(const ListedVerb& verb) {
  std::string usage = "sunder " + verb.name + " [OPTIONS]";
  for (const ListedOption& positional : verb.positionals)
    usage += positional.is_required ? ' ' + positional.names.front()
                                    : " [" + positional.names.front() + ']';
  std::string section =
      ".SS \"" + escaped_for_roff(usage) + "\"\n" + escaped_for_roff(verb.text) + ".\n";
  for (const ListedOption& positional : verb.positionals) section += option_entry(positional);
  for (const ListedOption& option : verb.options) section += option_entry(option);
  return section + ".PP\n" + paragraphs(verb.footer);
}

}  // namespace

std::string manual_page(const std::vector<ListedVerb>& verbs, const std::string& version) {
  const ListedVerb& command = verbs.front();
  std::string page = ".TH SUNDER 1 \"\" \"" + escaped_for_roff(version) +
                     "\" \"User Commands\"\n.SH NAME\nsunder \\- tears rigged, animated models\n"
                     ".SH SYNOPSIS\n.B sunder\n.I VERB\n[\\fIOPTIONS\\fR] ...\n.SH OPTIONS\n";
  for (const ListedOption& option : command.options) page += option_entry(option);
  page += ".SH VERBS\n";
  for (std::size_t i = 1; i < verbs.size(); ++i) page += verb_section(verbs[i]);
  page += ".SH EXIT STATUS\n" + paragraphs(command.footer) +
          ".SH ENVIRONMENT\n.TP\n\\fBNO_COLOR\\fR\nIf it is set and not empty, messages have no "
          "colours.\n";
  return page;
}

}  // namespace sunder::tools
