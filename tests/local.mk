# unit tests: tests/unit/test_NAME.c, linked with all of lib/
unit_ldadd = libcore.la $(TEST_LDFLAGS)

# what tests that run the program get: the program, the sources, and what it takes to build more
AM_TESTS_ENVIRONMENT = COTREE='$(abs_builddir)/cotree'; TOP_SRCDIR='$(abs_srcdir)'; \
	TOP_BUILDDIR='$(abs_builddir)'; MAKE='$(MAKE)'; CC='$(CC)'; \
	SAN_CFLAGS='$(SAN_CFLAGS)'; GNUPLOT='$(GNUPLOT)'; \
	export COTREE TOP_SRCDIR TOP_BUILDDIR MAKE CC SAN_CFLAGS GNUPLOT;

include tests/unit/base.mk
include tests/unit/expr.mk
include tests/unit/graph.mk
include tests/unit/compile.mk
include tests/unit/syntax.mk
include tests/unit/model.mk
include tests/unit/joints.mk
include tests/unit/formulate.mk
include tests/unit/spatial.mk
include tests/unit/simulate.mk
include tests/unit/session.mk
include tests/unit/networks.mk
include tests/unit/domains.mk
include tests/unit/parts.mk
include tests/session/session.mk
include tests/terminal/terminal.mk
include tests/oracle/spice.mk
include tests/oracle/urdf.mk
include tests/bench/bench.mk
include tests/bench/algebra.mk
include tests/bench/expr.mk
include tests/bench/edit.mk
include tests/bench/formulate.mk
include tests/bench/subsystems.mk
include tests/bench/graph.mk
include tests/bench/compile.mk
include tests/bench/dynamics.mk
include tests/bench/simulate.mk
include tests/bench/session.mk
include tests/bench/network.mk
include tests/fmu/fmu.mk
include tests/fuzz/fuzz.mk
include tests/family/family.mk

check_PROGRAMS += $(UNIT_TESTS) $(FAMILIES)
# what takes longest comes first, so that at the end no processor waits for one test
TESTS += $(FAMILIES) $(UNIT_TESTS)
EXTRA_PROGRAMS += $(BENCHES) $(FUZZERS)
EXTRA_DIST += tests/claims.sh tests/family/family.h

# tests that are scripts
SCRIPT_TESTS = \
	tests/cases/andrews \
	tests/cases/beams \
	tests/cases/exported_code \
	tests/cases/exported_inverse \
	tests/cases/fmu \
	tests/cases/four_bar \
	tests/cases/free_body \
	tests/cases/heavy_top \
	tests/cases/library \
	tests/cases/machines \
	tests/cases/microphone \
	tests/cases/motor_arm \
	tests/cases/parallel \
	tests/cases/pendulum \
	tests/cases/read_back \
	tests/cases/serial \
	tests/cases/shown_fortran \
	tests/cases/slider_crank \
	tests/cases/spatial_slider_crank \
	tests/cases/tours \
	tests/dev/tools_tell_right_from_wrong \
	tests/doc/equations_come_out_on_paper \
	tests/doc/graphviz_reads_the_graph \
	tests/doc/manual_and_readme_are_true \
	tests/gallery/pictures_show_what_was_asked_for \
	tests/install/installed_library_builds_a_program
TESTS += $(SCRIPT_TESTS)
EXTRA_DIST += $(SCRIPT_TESTS) tests/cases/cases.sh tests/cases/columns_agree \
	tests/gallery/look.py \
	tests/cases/microphone_equations.py \
	tests/data/andrews_beta062.csv tests/data/free_body.csv tests/data/heavy_top.csv \
	tests/data/beam_spin_up.csv tests/data/microphone.csv tests/data/spatial_beam.csv \
	tests/data/parallel_inverse.csv \
	tests/data/serial_motion.csv tests/data/serial_states.csv \
	tests/data/spatial_slider_crank_a.csv tests/data/spatial_slider_crank_c.csv
