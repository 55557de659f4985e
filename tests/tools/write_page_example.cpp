// Writes the page of the example, for docs/pictures/validation_page.png and to be looked at.

#include <cstdio>

#include "support/models/page_example.h"
#include "tools/validation_page/write_page.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  sunder::test::PageExample example;
  sunder::test::make_page_example(example);
  const sunder::Status status = sunder::tools::write_validation_page(argv[1], example.input);
  if (!status) std::fprintf(stderr, "%s\n", status.text().data());
  return status ? 0 : 1;
}
