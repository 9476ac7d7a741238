/* mutate.h: random statements, made from good ones, thrown at a target until the time is up
 *
 * The driver reads every script (.ct), text (.txt), netlist (.cir) and robot (.urdf) below the
 * folders that it is given, and the examples of the help. It needs no compiler of its own; with
 * clang the same targets are libFuzzer's: clang -DLIBFUZZER -fsanitize=fuzzer,address,undefined ...
 * and the sources of lib/ */
#ifndef COTREE_TESTS_MUTATE_H
#define COTREE_TESTS_MUTATE_H

#include <stddef.h>

/* What is tested: `text` ends with a NUL, as do no parts of it. Aborts when something is wrong. */
typedef void (*Target)(const char *text);

/* fuzz_x [--seconds N] [--seed N] FOLDER...: runs the target; the status to exit with. An input
 * that fails or takes more than ten seconds is written to fuzz-fault.txt. */
int mutate_main(int argc, char **argv, Target target);

/* Fail with a message unless the claim holds. */
void mutate_claim(int holds, const char *claim);

#endif
