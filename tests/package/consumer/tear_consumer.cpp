// A program that tears and refits, but never fits neighbouring points together.

#include <sunder/tear/refit_job.h>

#include <cstdio>

int main() {
  const auto model = sunder::TornModel::create(std::shared_ptr<const sunder::Character>());
  std::puts(model ? "unexpected" : model.error().text().data());
  return model ? 1 : 0;
}
