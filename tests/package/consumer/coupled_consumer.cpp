// A program that asks for coupled refits.

#include <sunder/coupled_refit/use.h>
#include <sunder/tear/refit_job.h>

#include <cstdio>

int main() {
  sunder::use_coupled_refit();
  const auto model = sunder::TornModel::create(std::shared_ptr<const sunder::Character>());
  std::puts(model ? "unexpected" : model.error().text().data());
  return model ? 1 : 0;
}
