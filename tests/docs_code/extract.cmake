# Writes the C++ blocks of README.md and docs/*.md into one source: cmake -D ROOT=… -D OUTPUT=… -P extract.cmake
#
# A block that includes headers is a file of its own: its includes come first, the rest stands in a namespace. Any other block is a
# fragment: the body of a function. The names that it uses and does not declare are the function's parameters, listed in a comment
# on the line above the block, which does not show on the page:
#
#   <!-- given: TornModel& model, const ModelPose& pose -->
#
# #line directives make the compiler name the page and its lines.
#
# With -D PAGE=… only the fragments of that page are written, each as a function named after the heading above it: those below
# "## Paper with holes" are paper_with_holes(), paper_with_holes_2() and so on.
cmake_minimum_required(VERSION 3.25)

set(includes "#include <sunder/sunder.h>\n")
set(code "")
set(number 0)

# Splits `text` before and after its first `mark`; `after` is empty if there is none.
function(split text mark before after)
  string(FIND "${text}" "${mark}" at)
  if(at EQUAL -1)
    set(${before} "${text}" PARENT_SCOPE)
    set(${after} "" PARENT_SCOPE)
    return()
  endif()
  string(LENGTH "${mark}" length)
  string(SUBSTRING "${text}" 0 ${at} head)
  math(EXPR at "${at} + ${length}")
  string(SUBSTRING "${text}" ${at} -1 tail)
  set(${before} "${head}" PARENT_SCOPE)
  set(${after} "${tail}" PARENT_SCOPE)
endfunction()

function(count_lines text count)
  string(REGEX REPLACE "[^\n]" "" newlines "${text}")
  string(LENGTH "${newlines}" length)
  set(${count} ${length} PARENT_SCOPE)
endfunction()

# The name of a fragment's function after the last heading of the text before it.
function(name_after_heading before name)
  string(REGEX MATCHALL "\n## [^\n]*" headings "${before}")
  if(headings)
    list(GET headings -1 heading)
    string(TOLOWER "${heading}" heading)
    string(REGEX REPLACE "[^a-z0-9]+" "_" heading "${heading}")
    string(REGEX REPLACE "^_" "" heading "${heading}")
    set(${name} ${heading} PARENT_SCOPE)
    set(below_heading 1 PARENT_SCOPE)
  else()
    math(EXPR below_heading "${below_heading} + 1")
    set(below_heading ${below_heading} PARENT_SCOPE)
    string(REGEX REPLACE "_[0-9]+$" "" stem "${${name}}")
    set(${name} ${stem}_${below_heading} PARENT_SCOPE)
  endif()
endfunction()

function(add_block page line given block)
  math(EXPR number "${number} + 1")
  set(name block_${number})
  if(PAGE)
    set(name ${heading_name})
  endif()
  if(block MATCHES "#include")
    string(REGEX MATCHALL "#include[^\n]*\n" lines "${block}")
    list(JOIN lines "" lines)
    string(APPEND includes "${lines}")
    string(REGEX REPLACE "#include[^\n]*\n" "\n" rest "${block}")
    string(APPEND code "namespace block_${number} {\n#line ${line} \"${page}\"\n${rest}}\n")
  else()
    string(APPEND code
      "inline sunder::Status ${name}(${given}) {\n#line ${line} \"${page}\"\n${block}return {};\n}\n")
  endif()
  foreach(result IN ITEMS number includes code)
    set(${result} "${${result}}" PARENT_SCOPE)
  endforeach()
endfunction()

if(PAGE)
  set(pages ${PAGE})
else()
  file(GLOB pages RELATIVE ${ROOT} ${ROOT}/README.md ${ROOT}/docs/*.md ${ROOT}/docs/command/*.md ${ROOT}/docs/method/*.md)
endif()
foreach(page IN LISTS pages)
  file(READ ${ROOT}/${page} text)
  set(line 1)
  while(NOT text STREQUAL "")
    split("${text}" "```cpp\n" before text)
    split("${text}" "```" block text)
    count_lines("${before}" count)
    math(EXPR line "${line} + ${count} + 1")
    name_after_heading("${before}" heading_name)
    set(given "")
    if(before MATCHES "<!-- given: ([^\n]*) -->\n$")
      set(given "${CMAKE_MATCH_1}")
    endif()
    if(NOT block STREQUAL "")
      add_block("${page}" ${line} "${given}" "${block}")
    endif()
    count_lines("${block}" count)
    math(EXPR line "${line} + ${count}")
  endwhile()
endforeach()
file(WRITE ${OUTPUT} "${includes}\nnamespace docs_code {\nusing namespace sunder;\n${code}}\n")
