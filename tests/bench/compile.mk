BENCHES += bench_program
bench_program_SOURCES = tests/bench/bench_program.c tests/bench/bench.h
bench_program_LDADD = $(unit_ldadd)
