# unit tests of lib/simulate
UNIT_TESTS += test_simulate_linear test_integration test_simulate_run test_simulate_cases \
  test_result test_kkt_border test_sweep test_fit test_optimiser test_triangular
test_fit_SOURCES = tests/unit/test_fit.c tests/unit/test.h
test_fit_LDADD = $(unit_ldadd)
test_optimiser_SOURCES = tests/unit/test_optimiser.c tests/unit/test.h
test_optimiser_LDADD = $(unit_ldadd)
test_sweep_SOURCES = tests/unit/test_sweep.c tests/unit/test.h
test_sweep_LDADD = $(unit_ldadd)
test_kkt_border_SOURCES = tests/unit/test_kkt_border.c tests/unit/test.h
test_kkt_border_LDADD = $(unit_ldadd)
test_triangular_SOURCES = tests/unit/test_triangular.c tests/unit/test.h
test_triangular_LDADD = $(unit_ldadd)
test_simulate_linear_SOURCES = tests/unit/test_simulate_linear.c tests/unit/test.h
test_simulate_linear_LDADD = $(unit_ldadd)
test_integration_SOURCES = tests/unit/test_integration.c tests/unit/simulate_problems.h \
  tests/unit/test.h
test_integration_LDADD = $(unit_ldadd)
test_simulate_cases_SOURCES = tests/unit/test_simulate_cases.c tests/unit/simulate_script.h \
  tests/unit/test.h
test_simulate_cases_LDADD = $(unit_ldadd)
test_simulate_run_SOURCES = tests/unit/test_simulate_run.c tests/unit/simulate_script.h \
  tests/unit/test.h
test_simulate_run_LDADD = $(unit_ldadd)
test_result_SOURCES = tests/unit/test_result.c tests/unit/simulate_script.h tests/unit/test.h
test_result_LDADD = $(unit_ldadd)
EXTRA_DIST += tests/data/README tests/data/andrews.csv tests/data/four_bar.csv \
  tests/data/motor_arm_forward.csv tests/data/motor_arm_inverse.csv tests/data/pendulum_10s.csv \
  tests/data/pendulum_2000s.csv tests/data/slider_crank.csv
