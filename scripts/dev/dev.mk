# for developers: the same tests in other builds, lint, benchmarks, fuzzing, coverage
#
# None of these installs anything: what is missing is named (or scripts/dev/packages lint).
dev = $(SHELL) $(srcdir)/scripts/dev
EXTRA_DIST += autogen.sh run-demo run-tests .clang-format .clang-tidy .shellcheckrc \
	scripts/dev/bench-compare scripts/dev/bench-table scripts/dev/build scripts/dev/check-hacking scripts/dev/check-layers scripts/dev/check-names scripts/dev/names-out scripts/dev/check-size \
	scripts/dev/check-tables scripts/dev/check-unused scripts/dev/coverage scripts/dev/lint \
	scripts/dev/packages scripts/dev/pictures scripts/dev/precision-pictures scripts/dev/scaling-pictures scripts/dev/total scripts/dev/transcripts

# all tests, with their sum as the last line
check-total: all
	@$(MAKE) -s check TESTS= >check.log 2>&1 || { cat check.log; exit 1; }
	@$(MAKE) -s check 2>&1 | grep -E '^(PASS|FAIL|SKIP|ERROR|XPASS)' || :
	@$(dev)/total $(TEST_LOGS)

# the same tests in a build with the address and undefined-behaviour sanitizers, where tables, lists
# and chunks of memory begin with one element: what goes past its end is seen, what grows moves
# (-g1: a report names functions and lines, no variables; that compiles in less time)
# Units, sessions and terminals call all there is; families, manuals and long cases call the same in
# the same ways: check-san-all, where there is time.
check-san: san/Makefile
	@$(MAKE) -s -C san check-total TESTS="$(unit_and_session) $(terminal_tests)" check_PROGRAMS="$(unit_and_session)"

check-san-all: san/Makefile
	@$(MAKE) -s -C san check-total

san/Makefile:
	@mkdir -p san
	@cd san && $(abs_srcdir)/configure -q --enable-sanitizers --enable-small --enable-werror CFLAGS='-O1 -g1'

# what uses several threads, where the thread sanitizer watches who touches what
threads/Makefile:
	@mkdir -p threads
	@cd threads && $(abs_srcdir)/configure -q --enable-werror CFLAGS='-O1 -g -fsanitize=thread' LDFLAGS='-fsanitize=thread'

sharing_tests = test_threads test_evaluator family_legs
check-threads: threads/Makefile
	@$(MAKE) -s -C threads $(sharing_tests)
	@for test in $(sharing_tests); do TSAN_OPTIONS=halt_on_error=1 threads/$$test || exit 1; done

# each call tried with allocations that fail (lib/base/faults.c). Units and sessions are what calls
# the library in all its ways; manuals and long cases call it in the same ones. With those of the
# shell that want a terminal they tell the lines that are reached.
unit_and_session = run-session $(filter-out test_costs,$(UNIT_TESTS))

check-faults: faults/Makefile
	@find faults -name '*.gcda' -exec rm -f {} +
	@$(MAKE) -s -C faults check-total TESTS="$(unit_and_session) $(terminal_tests)" check_PROGRAMS="$(unit_and_session)"
	@$(dev)/coverage faults

faults/Makefile:
	@mkdir -p faults
	@cd faults && $(abs_srcdir)/configure -q --enable-faults --enable-coverage --enable-werror CFLAGS='-O1 -g1'

# make lint PARTS="format size": only these; lint-all: clang-tidy reads what has not changed, too
lint: lint_scope =
lint-all: lint_scope = --all
lint lint-all:
	@BUILD='$(abs_top_builddir)' CC='$(CC)' CPPFLAGS='-D_GNU_SOURCE -I$(abs_top_builddir) $(GSL_CFLAGS) $(KLU_CFLAGS)' \
		$(dev)/lint $(lint_scope) $(PARTS)

# the diffs of doc/HACKING, applied to a copy, build and run
check-hacking: all
	@$(dev)/check-hacking $(abs_builddir)

format:
	cd $(srcdir) && find lib src tests -name '*.[ch]' -exec clang-format -i {} +

benches: all
	@$(MAKE) -s $(BENCHES)

# times, beside those of the last record; each program is told of the scripts and the shell
bench: benches
	@rm -rf bench.work; mkdir bench.work
	@for bench in $(BENCHES); do \
		(cd bench.work && TOP_SRCDIR=$(abs_srcdir) LD_LIBRARY_PATH=../.libs ../$$bench $(abs_srcdir)/scripts \
			$(abs_builddir)/.libs/cotree) || echo "# $$bench: failed"; \
	done >bench.out
	@$(dev)/bench-table $(srcdir)/tests/bench/record.txt <bench.out
	@status=0; ! grep '^# bench_.*: failed' bench.out || status=1; \
	for part in bench-instructions bench-precision bench-scaling bench-estimates bench-peers bench-races bench-latency; do $(MAKE) -s $$part || status=1; done; \
		exit $$status

# work against precision of every reference and stress case, by method: a table, and pictures in
# precision/
bench-precision: all
	@rm -rf precision; mkdir precision
	@status=0; $(srcdir)/tests/bench/precision.py -o precision/data ./cotree $(srcdir) \
		>precision/rows || status=1; cat precision/rows; \
	$(dev)/precision-pictures precision/data svg precision && \
		echo "pictures are in precision/" && exit $$status

# forming, memory, an evaluation and a run by the number of parts, and SymPy's forming beside ours
bench-scaling: all
	@rm -rf scaling; mkdir scaling
	@status=0; PYTHONDONTWRITEBYTECODE=1 $(srcdir)/tests/bench/scaling.py -o scaling/data ./cotree \
		>scaling/rows || status=1; cat scaling/rows; \
	$(dev)/scaling-pictures scaling/data svg scaling && \
		echo "the picture is in scaling/" && exit $$status

# what an edit leaves to form, where valgrind is there
bench-instructions: bench_edit bench_subsystems
	@PYTHONDONTWRITEBYTECODE=1 $(srcdir)/tests/bench/instructions.py .

# what check=on says of its error, over the error, by case, method and tolerance
bench-estimates: all
	@PYTHONDONTWRITEBYTECODE=1 $(srcdir)/tests/bench/estimates.py ./cotree $(srcdir)

# a robot and chains by MuJoCo and Simbody, where their libraries are there, beside ours
bench-peers: all
	@$(MAKE) -s bench_dynamics
	@rm -rf bench.work; mkdir bench.work
	@PYTHONDONTWRITEBYTECODE=1 $(srcdir)/tests/bench/peers.py ./bench_dynamics bench.work

# whole runs of chains and four-bars by them, beside ours at the same error
bench-races: all
	@rm -rf bench.work; mkdir bench.work
	@PYTHONDONTWRITEBYTECODE=1 $(srcdir)/tests/bench/races.py bench.work ./cotree $(srcdir)

# a key and Ctrl-C at the prompt, with 300 bodies
bench-latency: all
	@PYTHONDONTWRITEBYTECODE=1 $(srcdir)/tests/bench/latency.py ./cotree

bench-record: bench
	{ head -n 3 $(srcdir)/tests/bench/record.txt; cat bench.out; } >bench.new
	mv bench.new $(srcdir)/tests/bench/record.txt

# what the manual's pictures and table of work and precision show
precision-record: all
	$(srcdir)/tests/bench/precision.py -o $(srcdir)/tests/bench/precision.dat ./cotree $(srcdir) \
		double_pendulum andrews_absolute rectifier bushing

# what the manual's picture of scaling shows; rows that fail are none of it
scaling-record: all
	-PYTHONDONTWRITEBYTECODE=1 $(srcdir)/tests/bench/scaling.py -o $(srcdir)/tests/bench/scaling.dat ./cotree

# random statements against the sanitizers, for so many seconds of processors in all; `all` is a make
# of its own, which beside the fuzzers would link the library twice at a time
FUZZ_SECONDS = 600
FUZZ_SEED = 1
fuzz: san/Makefile
	@$(MAKE) -s -C san all
	@$(MAKE) -s -C san $(FUZZERS)
	@set -- $(FUZZERS); each=$$(($(FUZZ_SECONDS) / $$#)); printf '%s\n' "$$@" | \
		xargs -P "$$(nproc)" -I FUZZER env san/FUZZER --seconds $$each --seed $(FUZZ_SEED) \
			$(srcdir)/scripts $(srcdir)/tests/oracle

# random members of families, for so many seconds in all, from that seed; make check has a few
STRESS_SECONDS = 600
STRESS_SEED = $$(date +%s)
stress: $(FAMILIES)
	@seed=$(STRESS_SEED); set -- $(FAMILIES); each=$$(($(STRESS_SECONDS) / $$#)); failed=0; \
	echo "seed $$seed, $$each s for each of $$# programs"; \
	for family; do ./$$family --seed $$seed --seconds $$each || failed=1; done; exit $$failed

# what all tests reach, line by line in coverage/NAME.c.gcov
check-coverage: coverage/Makefile
	@find coverage -name '*.gcda' -exec rm -f {} +
	@$(MAKE) -s -C coverage check-total
	@$(dev)/coverage coverage files

coverage/Makefile:
	@mkdir -p coverage
	@cd coverage && $(abs_srcdir)/configure -q --enable-coverage CFLAGS='-O0 -g'

mostlyclean-local:
	rm -f $(BENCHES) $(FUZZERS) bench.out check.log

distclean-local:
	rm -rf san threads faults coverage bench.work precision scaling

.PHONY: check-total check-hacking check-san check-san-all check-threads check-faults lint lint-all format bench benches bench-precision bench-scaling bench-estimates bench-peers bench-instructions bench-races bench-latency bench-record precision-record scaling-record fuzz stress check-coverage
