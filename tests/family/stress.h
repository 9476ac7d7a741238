/* stress.h: scripts that are run and told, for the families of what brings multibody programs down
 *
 * There are fifteen kinds of it: motions 1 to 5, 8 and 13 in family_stress_motions.c, of the
 * program about them 7, 10 to 12, 14 and 15 in family_stress_runs.c; change points (9) and
 * mechanisms of other sizes with rods without inertia about their axes (6) in family_mechanisms.c.
 * Each is held against a closed form, an integration that shares nothing with cotree, digits from
 * elsewhere, or what a motion keeps. */
#ifndef COTREE_TESTS_STRESS_H
#define COTREE_TESTS_STRESS_H

#include "mechanisms.h"

/* run a script, which is told */
static inline ct_status do_script(Member *member, Kit *kit, const Script *script)
{
    const ct_status status = kit_do(kit, script->text);

    tell(member, "%s", script->text);
    if (status != CT_OK)
        tell(member, "refused: %s\n", kit->error.message);
    return status;
}

/* a statement to a running session; what it refuses is told */
__attribute__((format(printf, 3, 4), unused)) static ct_status do_line(Member *member, Kit *kit,
                                                                       const char *format, ...)
{
    char line[400];
    va_list arguments;
    ct_status status;

    va_start(arguments, format);
    (void)vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    tell(member, "%s\n", line);
    status = kit_do(kit, line);
    if (status != CT_OK)
        tell(member, "refused: %s\n", kit->error.message);
    return status;
}

static inline const char *draw_word(Member *member, const char *const *words, int count)
{
    return words[draw_one_of(member, count)];
}

/* Andrews' squeezing mechanism at rest */
#define ANDREWS                                                                                    \
    "scene planar\n"                                                                               \
    "d = 0.028; da = 0.0115; e = 0.02; ea = 0.01421; rr = 0.007; ra = 0.00092; ss = 0.035\n"       \
    "sa = 0.01874; sb = 0.01043; sc = 0.018; sd = 0.02; ta = 0.02308; tb = 0.00916; u = 0.04\n"    \
    "ua = 0.01228; ub = 0.00449; zf = 0.02; zt = 0.04; fa = 0.01421\n"                             \
    "arm A ground [-0.06934, -0.00227]; arm B ground [-0.03635, 0.03273]\n"                        \
    "arm C ground [0.014, 0.072]\n"                                                                \
    "body K1 mass=0.04325 inertia=2.194e-6; body K2 mass=0.00365 inertia=4.410e-7\n"               \
    "body K3 mass=0.02373 inertia=5.255e-6; body K4 mass=0.00706 inertia=5.667e-7\n"               \
    "body K5 mass=0.07050 inertia=1.169e-5; body K6 mass=0.00706 inertia=5.667e-7\n"               \
    "body K7 mass=0.05498 inertia=1.912e-5\n"                                                      \
    "arm O1 K1 [-ra, 0]; arm F1 K1 [rr - ra, 0]; arm F2 K2 [da, 0]; arm E2 K2 [da - d, 0]\n"       \
    "arm B3 K3 [-sb, sa]; arm E3 K3 [-sb, sa - ss]; arm D3 K3 [sd - sb, sa - sc]\n"                \
    "arm G4 K4 [0, e - ea]; arm E4 K4 [0, -ea]; arm A5 K5 [-ta, -tb]; arm G5 K5 [zt - ta, -tb]\n"  \
    "arm H6 K6 [fa - zf, 0]; arm E6 K6 [fa, 0]; arm A7 K7 [-ub, ua]; arm H7 K7 [-ub, ua - u]\n"    \
    "revolute jO ground O1 coord=beta; revolute jF F1 F2 coord=Theta\n"                            \
    "revolute jB B B3 coord=gamma; revolute jG G5 G4 coord=Phi\n"                                  \
    "revolute jA5 A A5 coord=delta; revolute jH H7 H6 coord=Omega\n"                               \
    "revolute jA7 A A7 coord=epsilon\n"                                                            \
    "revolute jE3 E3 E2; revolute jE4 E4 E2; revolute jE6 E6 E2\n"                                 \
    "spring k1 C D3 k=4530 length=0.07785; torque mom K1 0.033\n"                                  \
    "init beta = -0.0617138900142764496, beta' = 0\n"                                              \
    "guess Theta = 0, gamma = 0.455279819163070380, Phi = 0.222668390165885885\n"                  \
    "guess delta = 0.487364979543842550, Omega = -0.222668390165885885\n"                          \
    "guess epsilon = 1.23054744454982120\n"

#endif
