/* multinomial.h: polynomials in several variables over unbounded integers (FLINT)
 *
 * All polynomials belong to a Ring, which has a fixed count of variables and bounds the work. The
 * ring records the first result beyond the bound, or a stop; later results are valid objects
 * without meaning. After the last operation the caller checks ring_status() once. Every polynomial
 * returned is new and immutable, and lives until multinomial_free() or the end of its ring.
 * Variable 0 is first in the order of terms.
 *
 * A ring lives within one call of the library, after flint_load(), and a thread has one at a time:
 * exact_memory.h. */
#ifndef COTREE_ALGEBRA_MULTINOMIAL_H
#define COTREE_ALGEBRA_MULTINOMIAL_H

#include "base/call_monitor.h"
#include "base/memory.h"

#include <gmp.h>

typedef struct Ring Ring;
typedef struct Multinomial Multinomial;
typedef LIST(Multinomial *) MultinomialList;

/* no polynomial of more than `most` terms */
Ring *ring_new(int variables, int most, const CallMonitor *watch); /* new; ring_free() */
void ring_free(Ring *ring);                                        /* NULL is fine */
Status ring_status(const Ring *ring); /* OK, E_MEMORY: beyond the bound, E_STOPPED */

Multinomial *multinomial_integer(Ring *ring, const mpz_t value);
Multinomial *multinomial_small(Ring *ring, long value);
Multinomial *multinomial_variable(Ring *ring, int variable);
void multinomial_free(Multinomial *p); /* NULL is fine */

/* --- looking --- */

bool multinomial_failed(const Multinomial *p); /* its ring has */
bool multinomial_is_zero(const Multinomial *p);
bool multinomial_is_number(const Multinomial *p); /* zero too */
bool multinomial_is(const Multinomial *p, long value);
int multinomial_terms(const Multinomial *p);
/* the integer of a term, until the next call with the ring */
const mpz_t *multinomial_factor(const Multinomial *p, int term);
int multinomial_power(const Multinomial *p, int term, int variable);
int multinomial_degree(const Multinomial *p, int variable); /* of zero: 0 */
bool multinomial_is_negative(const Multinomial *p);         /* its first term is */

/* --- arithmetic --- */

Multinomial *multinomial_sum(const Multinomial *p, const Multinomial *q, int sign); /* p + sign q */
Multinomial *multinomial_times(const Multinomial *p, const Multinomial *q);
/* p/q, NULL where q does not divide p */
Multinomial *multinomial_quotient(const Multinomial *p, const Multinomial *q);
/* q with factor q^n = p, if p is known to have that form: as multinomial_quotient(), never NULL */
Multinomial *multinomial_exact(const Multinomial *p, const Multinomial *q);
Multinomial *multinomial_coefficient(const Multinomial *p, int variable, int power);

/* --- factors --- */

/* with a positive first term */
Multinomial *multinomial_gcd(const Multinomial *p, const Multinomial *q);
/* Factors whose product p is, none of them 1: an integer, variables, and what divides the
 * coefficients of p by some variable, or p and its slope. One that is linear in each of its
 * variables has no more. */
void multinomial_split(const Multinomial *p, MultinomialList *out);
void multinomials_free(MultinomialList *list); /* with its polynomials */

#endif
