# networks in both forms, and random ones
UNIT_TESTS += test_network
test_network_SOURCES = tests/unit/test_network.c tests/unit/session_kit.h tests/unit/test.h
test_network_LDADD = $(unit_ldadd)
UNIT_TESTS += test_random_networks
test_random_networks_SOURCES = tests/unit/test_random_networks.c tests/unit/scene.h tests/unit/test.h
test_random_networks_LDADD = $(unit_ldadd)
UNIT_TESTS += test_operating
test_operating_SOURCES = tests/unit/test_operating.c tests/unit/session_kit.h tests/unit/test.h
test_operating_LDADD = $(unit_ldadd)
UNIT_TESTS += test_equilibrium
test_equilibrium_SOURCES = tests/unit/test_equilibrium.c tests/unit/session_kit.h tests/unit/test.h
test_equilibrium_LDADD = $(unit_ldadd)
UNIT_TESTS += test_ideal
test_ideal_SOURCES = tests/unit/test_ideal.c tests/unit/session_kit.h tests/unit/test.h
test_ideal_LDADD = $(unit_ldadd)
