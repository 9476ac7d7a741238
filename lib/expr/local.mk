libcore_la_SOURCES += \
	lib/expr/expr.h lib/expr/expr_impl.h lib/expr/ops.def lib/expr/code_functions.def \
	lib/expr/angles.c lib/expr/arena.c lib/expr/call.c lib/expr/collect.c lib/expr/operations.c \
	lib/expr/derivatives.c lib/expr/diff.c lib/expr/evaluate.c lib/expr/expand.c lib/expr/fold.c \
	lib/expr/notations.def lib/expr/greek.c lib/expr/greek.h lib/expr/heap.c lib/expr/jumps.c lib/expr/jumps.h lib/expr/notation.c lib/expr/number.c lib/expr/order.c \
	lib/expr/print.c lib/expr/print_code.c lib/expr/print_impl.h lib/expr/print_latex.c \
	lib/expr/print_text.c lib/expr/print_tree.c lib/expr/product.c \
	lib/expr/range.c lib/expr/range.h lib/expr/rename.c \
	lib/expr/share.c lib/expr/substitute.c lib/expr/sum.c lib/expr/curve.c lib/expr/curve.h \
	lib/expr/units.c lib/expr/units.h lib/expr/walk.c
