# Shortcuts: each target installs missing packages, configures, builds and runs, using the CMake presets.
.DEFAULT_GOAL := help
.PHONY: help demo pictures unit test check coverage same-bits bench stress fuzz format
jobs := $(shell nproc)

help:
	@echo 'make demo     tears a model in the middle of its animation; pictures, GLB and report in demo/'
	@echo 'make pictures draws all pictures of docs/ anew; before and after side by side in build/pictures/'
	@echo 'make unit     builds everything and runs the unit tests, which take some minutes'
	@echo 'make test     builds everything and runs all tests'
	@echo 'make check    format, clang, clang-tidy on what changed, and tests under the sanitizers'
	@echo 'make coverage lines and branches of core, tear and weights that their tests run; fails below 95 and 85 %'
	@echo 'make same-bits tries the same cases with gcc, optimised and not, and with clang: the results must have the same bits'
	@echo 'make bench    runs the benchmarks'
	@echo 'make stress   all tests with many more random cases, then again under the sanitizers'
	@echo 'make fuzz     runs each fuzz target by libFuzzer for FUZZ_SECONDS (300); needs clang'
	@echo 'make format   clang-format over all our C++'

demo:
	@echo 'Installs packages, builds (about 8 minutes on two cores), then tears a model: progress is printed.'
	scripts/setup
	cmake --preset release
	cmake --build --preset release --target sunder
	build/release/tools/sunder demo -o demo

pictures:
	scripts/setup test pictures
	cmake --preset release
	cmake --build --preset release --target sunder soft_pictures write_page_example
	scripts/pictures --compare build/pictures

unit:
	scripts/setup test
	cmake --preset release
	cmake --build --preset release
	ctest --preset release -L unit -j $(jobs)

test:
	@echo 'Installs packages, builds (less than half an hour on two cores), then runs the tests (about 12 minutes).'
	scripts/setup test
	cmake --preset release
	cmake --build --preset release
	ctest --preset release -j $(jobs)

check:
	scripts/setup check
	scripts/check

coverage_tests := tear_test refit_test weights_test contact_test detach_test core_test memory_operators_test
coverage:
	scripts/setup coverage
	cmake --preset coverage
	cmake --build --preset coverage --target $(coverage_tests)
	scripts/coverage $(coverage_tests)

same_bits_builds := release debug clang
same-bits:
	scripts/setup clang
	set -e; for build in $(same_bits_builds); do cmake --preset $$build; \
	  cmake --build --preset $$build --target sunder-stress; done
	scripts/same_bits $(same_bits_builds)

bench:
	scripts/setup
	cmake --preset release
	cmake --build --preset release --target bench

stress_seconds := $(or $(STRESS_SECONDS),3600)
stress:
	scripts/setup test
	cmake --preset release
	cmake --build --preset release
	SUNDER_STRESS=1 ctest --preset release -j $(jobs)
	build/release/bench/sunder-stress --seconds $(stress_seconds) --log build/stress.jsonl --summary
	cmake --preset asan
	cmake --build --preset asan
	ctest --preset asan -j $(jobs)

fuzz_seconds := $(or $(FUZZ_SECONDS),300)
fuzzers = $(patsubst tests/fuzz/%_fuzzer.cpp,%,$(wildcard tests/fuzz/*_fuzzer.cpp))
fuzz:
	scripts/setup fuzz
	cmake --preset fuzz
	cmake --build --preset fuzz --target $(addsuffix _fuzzer,$(fuzzers))
	scripts/fuzz $(fuzz_seconds) $(fuzzers)

format:
	scripts/setup format
	git ls-files -z '*.h' '*.cpp' | xargs -0 clang-format -i
