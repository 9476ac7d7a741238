/* formulate_limits.h: tolerances and limits of lib/formulate, by file
 *
 * Relative and without unit where none is stated. They decide between exact expressions where only
 * numbers of the parameters can. */
#ifndef COTREE_FORMULATE_FORMULATE_LIMITS_H
#define COTREE_FORMULATE_FORMULATE_LIMITS_H

/* --- redundancy.c --- */

/* pivot of directions of unit length: a smaller one counts as 0 */
#define REDUNDANCY_ZERO 1e-9

/* --- constraint_rows.c --- */

/* m, or 1 for directions; smaller differences count as 0 */
#define CONSTRAINT_MISFIT 1e-9

/* --- network_nodes.c --- */

/* terms; a voltage that sums more, or a cutset with more currents, is expressed by node potentials
 */
#define NETWORK_LONG_SUM 8

/* --- network_order.c --- */

/* rounds that lower the order of equations, at most */
#define NETWORK_ROUNDS 200

/* nodes of expressions of explicit state equations, at most; nobody would read longer ones */
#define NETWORK_MOST_NODES 20000

/* --- response.c --- */

/* of the sum of sizes of its terms: a smaller coefficient counts as 0 */
#define RESPONSE_ZERO 1e-9

/* --- continuity.c --- */

/* of the point: distance at which the size of an expression that is 0 there is taken */
#define CONTINUITY_AWAY 1.0

/* of the sizes of both: values of branches that differ by less are equal */
#define CONTINUITY_CLOSED 1e-9

/* of the point: distance of the neighbouring points */
#define CONTINUITY_NEXT 1e-14

/* of the difference at CONTINUITY_AWAY: a larger one at a neighbouring point is a jump */
#define CONTINUITY_JUMP 1e-6

/* --- switches.c --- */

/* rounding error of a constant */
#define SWITCH_ROUNDING 1e-14

#endif
