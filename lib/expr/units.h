/* units.h: units of the command language; values are in SI */
#ifndef COTREE_EXPR_UNITS_H
#define COTREE_EXPR_UNITS_H

#include "base/diag.h"
#include "base/text.h"

/* exponents of m, kg, s, A, K, rad (rad only distinguishes angles from numbers in printing;
 * dimension_same() ignores it) */
typedef struct Dimension {
    signed char power[6];
} Dimension;

/* a unit that was written: value in SI = written * num/den * pi^pi_power exactly, or * factor */
typedef struct Unit {
    double factor;
    long long num; /* deg is 1/180 pi: num 1, den 180, pi_power 1 */
    long long den; /* 0 where the exact factor doesn't fit, and `factor` alone counts */
    int pi_power;
    Dimension dimension;
    bool is_cycles; /* Hz: a count of turns each second, where 1/s may be an angular rate */
} Unit;

/* One unit name with an optional SI prefix: mm, kohm, uF, deg, rpm. False where unknown. No
 * letter means two things: hour, day and tonne are spelled out, standard gravity is gn. */
bool unit_find(const char *name, Unit *unit);
/* A compound unit, the text between brackets: kN/m, m/s^2, 1/s. On failure *fault is the
 * offset of the part that isn't understood. */
bool unit_parse(const char *text, size_t length, Unit *unit, size_t *fault);
/* the unit that a word such as "sec" or "volts" means, or NULL */
const char *unit_spelled(const char *name);
/* what was probably meant by an unknown unit name, or NULL */
const char *unit_suggest(const char *name);
bool dimension_same(Dimension a, Dimension b);
bool dimension_has_angle(Dimension d);
/* Without the angle if there is a length, mass, current or temperature too: r*h' is in m/s. */
Dimension dimension_without_angle(Dimension d);
/* a * b^power; false, *out unchanged, where an exponent no longer fits */
bool dimension_times(Dimension a, Dimension b, int power, Dimension *out);
/* the square root; false where an exponent is odd (an angle's doesn't count) */
bool dimension_root(Dimension a, Dimension *out);
/* kg*m^2, with a name where that is shorter: N, V, N/m, N*m (of work and of torque), 1 for none */
void dimension_print(Text *text, Dimension dimension);
/* The same in the units of a list, "mm deg rpm": one of that dimension, or of lengths, times and
 * angles one for each, deg/s. A number in SI is divided by the result. N*m is a torque here (Nm in
 * the list); J, kJ, Wh are energies, which have a function of their own. */
double dimension_print_in(Text *text, Dimension dimension, const char *units);
double energy_print_in(Text *text, const char *units);
/* Whether a text is such a list, of units of different dimensions; torque and energy count as two.
 * E_UNIT gives the reason if not. */
MUST_USE Status unit_list_check(const char *units, Diag *diag);
/* every unit name without prefix, for completion: call with 0, 1, ... until NULL */
const char *unit_name(int i);
const char *unit_prefix(int i); /* likewise; the first is "" */
const char *unit_common(int i); /* likewise: names with a prefix that people use: mm, kohm */

#endif
