/* mutate.h: random statements, made from good ones, thrown at a target until the time is up
 *
 * The program is `fuzz_x [--seconds N] [--seed N] FOLDER...`: an input that fails or takes more
 * than ten seconds is written to fuzz-fault.txt. The driver reads every script (.ct), text (.txt),
 * netlist (.cir) and robot (.urdf) below the folders that it is given, and the examples of the
 * help. */
#ifndef COTREE_TESTS_MUTATE_H
#define COTREE_TESTS_MUTATE_H

/* What is tested, which each fuzzer defines: `text` ends with a NUL, as do no parts of it. Aborts
 * when something is wrong. */
void mutate_target(const char *text);

/* Fail with a message unless the claim holds. */
void mutate_claim(int holds, const char *claim);

#endif
