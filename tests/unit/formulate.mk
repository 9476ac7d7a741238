UNIT_TESTS += test_formulate
test_formulate_SOURCES = tests/unit/test_formulate.c tests/unit/test.h tests/unit/form.h tests/unit/scene.h
test_formulate_LDADD = $(unit_ldadd)

UNIT_TESTS += test_constrained
test_constrained_SOURCES = tests/unit/test_constrained.c tests/unit/test.h tests/unit/form.h tests/unit/scene.h
test_constrained_LDADD = $(unit_ldadd)
UNIT_TESTS += test_mass_matrix
test_mass_matrix_SOURCES = tests/unit/test_mass_matrix.c tests/unit/test.h tests/unit/form.h tests/unit/scene.h
test_mass_matrix_LDADD = $(unit_ldadd)

UNIT_TESTS += test_literals
test_literals_SOURCES = tests/unit/test_literals.c tests/unit/test.h tests/unit/form.h tests/unit/scene.h
test_literals_LDADD = $(unit_ldadd)

UNIT_TESTS += test_counts
test_counts_SOURCES = tests/unit/test_counts.c tests/unit/test.h tests/unit/form.h tests/unit/scene.h
test_counts_LDADD = $(unit_ldadd)

UNIT_TESTS += test_trees
test_trees_SOURCES = tests/unit/test_trees.c tests/unit/test.h tests/unit/form.h tests/unit/scene.h
test_trees_LDADD = $(unit_ldadd)

UNIT_TESTS += test_spatial
test_spatial_SOURCES = tests/unit/test_spatial.c tests/unit/spatial.h tests/unit/test.h \
  tests/unit/form.h tests/unit/scene.h
test_spatial_LDADD = $(unit_ldadd)

UNIT_TESTS += test_displaced
test_displaced_SOURCES = tests/unit/test_displaced.c tests/unit/session_kit.h tests/unit/test.h
test_displaced_LDADD = $(unit_ldadd)

UNIT_TESTS += test_system_view
test_system_view_SOURCES = tests/unit/test_system_view.c tests/unit/test.h tests/unit/form.h tests/unit/scene.h
test_system_view_LDADD = $(unit_ldadd)
