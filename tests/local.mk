# unit tests: tests/unit/test_NAME.c, linked with all of lib/
unit_ldadd = libcore.la

include tests/unit/base.mk
include tests/unit/expr.mk
include tests/unit/graph.mk
include tests/unit/compile.mk
include tests/unit/syntax.mk
include tests/unit/model.mk
include tests/unit/formulate.mk
include tests/unit/simulate.mk
include tests/session/session.mk
include tests/bench/bench.mk
include tests/bench/graph.mk
include tests/fuzz/fuzz.mk

check_PROGRAMS += $(UNIT_TESTS)
TESTS += $(UNIT_TESTS)
EXTRA_PROGRAMS += $(BENCHES) $(FUZZERS)
