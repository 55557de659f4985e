# Writes the C++ blocks of one page into a source that compiles them: cmake -D PAGE=… -D NAME=docs/tear.md -D OUTPUT=… -P extract.cmake
#
# A block that includes headers is a file of its own: its includes come first, the rest stands in a namespace. Any other block is a
# fragment: the body of a function. The names that it uses and does not declare are the function's parameters, listed in a comment
# directly above the block, which does not show on the page:
#
#   <!-- given: TornModel& model, const ModelPose& pose -->
#
# #line directives make the compiler name the page and its lines.
cmake_minimum_required(VERSION 3.25)
file(READ ${PAGE} rest)
set(includes "#include <sunder/sunder.h>\n")
set(code "")
set(line 1)
set(number 0)
while(TRUE)
  string(FIND "${rest}" "```cpp\n" begin)
  if(begin EQUAL -1)
    break()
  endif()
  string(SUBSTRING "${rest}" 0 ${begin} before)
  math(EXPR begin "${begin} + 7")
  string(SUBSTRING "${rest}" ${begin} -1 rest)
  string(FIND "${rest}" "```" length)
  string(SUBSTRING "${rest}" 0 ${length} block)
  string(SUBSTRING "${rest}" ${length} -1 rest)

  string(REGEX REPLACE "[^\n]" "" newlines "${before}")
  string(LENGTH "${newlines}" count)
  math(EXPR line "${line} + ${count} + 1")
  set(given "")
  if(before MATCHES "<!-- given: ([^\n]*) -->\n$")
    set(given "${CMAKE_MATCH_1}")
  endif()

  math(EXPR number "${number} + 1")
  if(block MATCHES "#include")
    string(REGEX MATCHALL "#include[^\n]*\n" lines "${block}")
    list(JOIN lines "" lines)
    string(APPEND includes "${lines}")
    string(REGEX REPLACE "#include[^\n]*\n" "\n" block_without "${block}")
    string(APPEND code "namespace block_${number} {\n#line ${line} \"${NAME}\"\n${block_without}}  // namespace\n")
  else()
    string(APPEND code "sunder::Status block_${number}(${given}) {\n#line ${line} \"${NAME}\"\n${block}return {};\n}\n")
  endif()

  string(REGEX REPLACE "[^\n]" "" newlines "${block}")
  string(LENGTH "${newlines}" count)
  math(EXPR line "${line} + ${count}")
endwhile()
if(number EQUAL 0)
  file(WRITE ${OUTPUT} "// ${NAME} shows no C++.\n")
  return()
endif()
file(WRITE ${OUTPUT} "${includes}\nnamespace docs_code {\nusing namespace sunder;\n${code}}  // namespace docs_code\n")
