# Checks that a page shows a whole sample, so that what it shows compiles and runs.
file(READ ${PAGE} page)
file(READ ${SAMPLE} sample)
string(FIND "${page}" "${sample}" found)
if(found EQUAL -1)
  message(FATAL_ERROR "${PAGE} does not show ${SAMPLE}")
endif()
