# the program in a terminal, driven by expect
TEST_EXTENSIONS = .exp
EXP_LOG_COMPILER = $(SHELL) $(srcdir)/tests/terminal/run-terminal
terminal_tests = \
    tests/terminal/banner.exp \
    tests/terminal/mistype.exp \
    tests/terminal/complete.exp \
    tests/terminal/define.exp \
    tests/terminal/history.exp \
    tests/terminal/interrupt_line.exp \
    tests/terminal/interrupt_run.exp \
    tests/terminal/interrupt_work.exp \
    tests/terminal/student.exp \
    tests/terminal/table_blocks.exp \
    tests/terminal/paste.exp \
    tests/terminal/paste_returns.exp \
    tests/terminal/recover.exp \
    tests/terminal/memory_end.exp \
    tests/terminal/pager.exp \
    tests/terminal/dumb.exp \
    tests/terminal/plot_text.exp \
    tests/terminal/plot_sizes.exp \
    tests/terminal/plot_file.exp \
    tests/terminal/plot_titles.exp \
    tests/terminal/bode.exp \
    tests/terminal/draw.exp \
    tests/terminal/resize.exp \
    tests/terminal/window.exp \
    tests/terminal/gnuplot_missing.exp \
    tests/terminal/gnuplot_killed.exp \
    tests/terminal/gnuplot_stuck.exp \
    tests/terminal/start_file.exp \
    tests/terminal/leave.exp
TESTS += $(terminal_tests)
EXTRA_DIST += $(terminal_tests) tests/terminal/run-terminal tests/terminal/common.exp
