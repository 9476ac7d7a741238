# random mechanisms against Simbody, where configure finds it
UNIT_TESTS += test_spatial_simbody
test_spatial_simbody_SOURCES = tests/unit/test_spatial_simbody.c tests/unit/spatial.h \
  tests/unit/scene.h tests/unit/test.h
test_spatial_simbody_LDADD = $(unit_ldadd)

oracle = $(srcdir)/tests/oracle/simbody_oracle.cpp
EXTRA_DIST += tests/oracle/simbody_oracle.cpp
if SIMBODY
check_SCRIPTS = simbody_oracle
CLEANFILES += simbody_oracle
endif

# no program of Automake's: a C++ compiler isn't asked for otherwise
simbody_oracle: $(oracle)
	$(AM_V_GEN)$(CXX) -O1 $(SIMBODY_CFLAGS) -o $@ $(oracle) $(SIMBODY_LIBS)
