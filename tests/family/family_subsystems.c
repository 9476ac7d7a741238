/* family_subsystems.c: random models made of subsystems, nested too, against the same parts written
 * out one by one
 *
 * The oracle knows nothing of definitions: each module writes its statements with its own prefix,
 * "leg_h" where an instance has leg.h, and the equations of that flat model have to be the same,
 * entry by entry, and its motion, too. What `save` writes is a third model, and undo and redo make
 * a fourth. */
#include "../unit/session_kit.h"
#include "family.h"

enum { MODULES = 3, USES = 8, ROOM = 16000 };

typedef struct Module { /* what a definition holds, drawn once */
    char name[16];
    bool planar, makes_tip, has_tree, has_start, has_law;
    int joint, inner; /* module inside, or -1 */
    double length, mass, inertia, stiffness, gain, angle, resistance;
    bool electric, through;
} Module;

typedef struct Writer {
    char text[ROOM];
    size_t length;
} Writer;

__attribute__((format(printf, 2, 3))) static void put(Writer *w, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    w->length +=
        (size_t)vsnprintf(w->text + w->length, sizeof w->text - w->length, format, arguments);
    va_end(arguments);
}

static Module draw_module(Member *member, int number, bool planar)
{
    Module m = {.planar = planar,
                .makes_tip = true,
                .has_tree = member_one_of(member, 2) == 0,
                .has_start = member_one_of(member, 2) == 0,
                .has_law = member_one_of(member, 2) == 0,
                .joint = member_one_of(member, 3),
                .inner = number > 0 && member_one_of(member, 2) == 0 ? member_one_of(member, number)
                                                                     : -1,
                .length = member_between(member, 0.3, 0.8),
                .mass = member_between(member, 0.5, 2),
                .inertia = member_between(member, 0.05, 0.2),
                .stiffness = member_between(member, 5, 40),
                .gain = member_between(member, 0.2, 0.6),
                .angle = member_between(member, -1, 1),
                .resistance = member_between(member, 1, 4),
                .electric = member_one_of(member, 2) == 0,
                .through = member_one_of(member, 2) == 0};

    (void)snprintf(m.name, sizeof m.name, "mod%d", number);
    return m;
}

static bool needs_terminal(const Module *all, const Module *m)
{
    return m->electric || (m->inner >= 0 && needs_terminal(all, &all[m->inner]));
}

/* The statements of a module. `p` stands before each of its names; `length` NULL: as drawn. */
static void put_parts(Writer *w, const Module *all, const Module *m, const char *p, const char *a,
                      const char *e, const char *length, bool flat)
{
    static const char *const joints[] = {"revolute", "revolute", "prismatic"};
    const char *law = m->has_law ? "push" : "";
    char given[40], inner[40], place[60];

    (void)snprintf(given, sizeof given, "%.15g", m->length);
    put(w, "%sL = %s\n", p, length != NULL ? length : given);
    if (m->has_law)
        put(w, "%s%s(x) = -%.15g*x*shared\n", p, law, m->stiffness);
    put(w,
        m->planar ? "body %sb mass=%.15g inertia=%.15g\n"
                  : "body %sb mass=%.15g inertia=[%.15g, 0.1, 0.12]\n",
        p, m->mass, m->inertia);
    put(w, m->planar ? "arm %sf %sb [-%sL/2, 0.1]\n" : "arm %sf %sb [-%sL/2, 0.1, 0.05]\n", p, p,
        p);
    put(w, m->planar ? "arm %stip %sb [%sL/2, 0]\n" : "arm %stip %sb [%sL/2, 0, 0.1]\n", p, p, p);
    put(w, "%s %sh %s %sf axis=%s\n", joints[m->joint], p, a, p,
        m->joint == 2   ? "x"
        : m->planar     ? "z"
        : m->joint == 1 ? "y"
                        : "z");
    if (m->has_law)
        put(w, "actuator %sact %sh %s=%s%s(%sh) - 0.3*%sh'\n", p, p,
            m->joint == 2 ? "force" : "torque", p, law, p, p);
    else
        put(w, "spring %ssp %sh k=%.15g rest=0.1\n", p, p, m->stiffness);
    if (m->electric) {
        put(w, "sensor %ssen %sh %sy 0 gain=%.15g\n", p, p, p, m->gain);
        put(w, "resistor %sR %s %so %.15g\n", p, e, p, m->resistance);
        put(w, "capacitor %sC %so %sy 0.05\n", p, p, p);
    }
    put(w, "output %sheight = %stip.y + %sL*%sh\n", p, p, p, p);
    if (m->has_start)
        put(w, "init %sh = %.15g, %sh' = %.15g\n", p, m->joint == 2 ? 0.1 * m->angle : m->angle, p,
            2 - m->angle);
    if (m->inner < 0)
        return;
    (void)snprintf(inner, sizeof inner, flat ? "%si_" : "%si", p);
    (void)snprintf(place, sizeof place, "%stip", p);
    if (flat) {
        char twice[60];

        (void)snprintf(twice, sizeof twice, "%sL*0.7", p);
        put_parts(w, all, &all[m->inner], inner, place, e, twice, true);
    } else
        put(w, "use %s %s A=%s%s%s L=L*0.7\n", all[m->inner].name, inner, place,
            needs_terminal(all, &all[m->inner]) ? " e=" : "",
            needs_terminal(all, &all[m->inner]) ? e : "");
}

static void put_definition(Writer *w, const Module *all, const Module *m)
{
    const bool terminal = needs_terminal(all, m);

    put(w, "subsystem %s frames=[A, tip]%s%s\n", m->name, terminal ? " terminals=[e]" : "",
        m->electric && m->through ? " through=[o]" : "");
    put_parts(w, all, m, "", "A", "e", NULL, false);
    if (m->has_tree)
        put(w, "tree h\n");
    put(w, "end\n");
}

typedef struct Placed {
    const Module *module;
    char place[2][20]; /* as the flat model calls it, and as the other does */
    char length[40];   /* "": as drawn */
} Placed;

typedef struct Narrative {
    Module modules[MODULES];
    Placed used[USES];
    int uses;
    bool planar, closes;
    Writer flat, made;
} Narrative;

/* a frame that is there: ground, or the tip of one before */
static void draw_place(Member *member, Narrative *s, int i)
{
    const int other = i > 0 ? member_one_of(member, i + 1) : i;

    if (other == i) {
        strcpy(s->used[i].place[0], "base");
        strcpy(s->used[i].place[1], "base");
        return;
    }
    (void)snprintf(s->used[i].place[0], 20, "u%d_tip", other);
    (void)snprintf(s->used[i].place[1], 20, "u%d.tip", other);
}

static void put_base(Writer *w, bool moves, bool planar)
{
    put(w, planar ? "scene planar\ngravity [0, -9.81]\n" : "gravity [0, -9.81, 0]\n");
    put(w, "shared = 1.3\n");
    put(w, planar ? "arm far ground [3, 2]\n" : "arm far ground [3, 2, 1]\n");
    if (moves) {
        put(w, planar ? "body cart mass=4 inertia=1\n" : "body cart mass=4 inertia=[1, 1, 1]\n");
        put(w, "prismatic rail ground cart axis=x\nspring hold rail k=30 rest=0\n");
        put(w, planar ? "arm base cart [0, 0.2]\n" : "arm base cart [0, 0.2, 0]\n");
    } else
        put(w, planar ? "arm base ground [0, 0.2]\n" : "arm base ground [0, 0.2, 0]\n");
}

/* A loop over ports: a rod of any length between the tips of the first two, pinned to both. */
static void put_loop(Writer *w, const Narrative *s, char dot)
{
    const char *joint = s->planar ? "revolute" : "spherical";
    const char *inertia = s->planar ? "0.05" : "[0.05, 0.06, 0.07]";

    put(w, "body link mass=0.7 inertia=%s\nbody slider mass=0.4 inertia=%s\n", inertia, inertia);
    put(w, "%s pin1 u0%ctip link\n", joint, dot);
    put(w, "prismatic slot link slider axis=x\nspring keep slot k=20 rest=0.5\n");
    put(w, "%s pin2 u1%ctip slider\nguess slot = 0.6\n", joint, dot);
}

static void draw_story(Member *member, Narrative *s)
{
    const bool moves = member_one_of(member, 2) == 0;
    const int kinds = 1 + member_one_of(member, MODULES); /* few: many instances of each */

    memset(s, 0, sizeof *s);
    s->planar = member_one_of(member, 3) > 0;
    for (int i = 0; i < MODULES; i++)
        s->modules[i] = draw_module(member, i, s->planar);
    s->uses = 1 + member_one_of(member, s->planar ? USES : USES / 2);
    for (int i = 0; i < s->uses; i++) {
        s->used[i].module = &s->modules[member_one_of(member, kinds)];
        draw_place(member, s, i);
        if (member_one_of(member, 2) == 0)
            (void)snprintf(s->used[i].length, 40, "%.15g", member_between(member, 0.3, 0.9));
    }
    put_base(&s->flat, moves, s->planar);
    put_base(&s->made, moves, s->planar);
    for (int i = 0; i < MODULES; i++)
        put_definition(&s->made, s->modules, &s->modules[i]);
    for (int i = 0; i < s->uses; i++) {
        const Placed *u = &s->used[i];
        char prefix[20];

        (void)snprintf(prefix, sizeof prefix, "u%d_", i);
        put_parts(&s->flat, s->modules, u->module, prefix, u->place[0], "in",
                  u->length[0] != '\0' ? u->length : NULL, true);
        put(&s->made, "use %s u%d A=%s%s%s%s\n", u->module->name, i, u->place[1],
            needs_terminal(s->modules, u->module) ? " e=in" : "", u->length[0] != '\0' ? " L=" : "",
            u->length);
    }
    if (s->uses > 1) {
        put(&s->flat, "spring ends far u1_tip k=12 length=0.4\n");
        put(&s->made, "spring ends far u1.tip k=12 length=0.4\n");
    }
    s->closes = s->uses > 1 && member_one_of(member, 2) == 0;
    if (s->closes) {
        put_loop(&s->flat, s, '_');
        put_loop(&s->made, s, '.');
    }
    put(&s->flat, "vsource V in 0 2 + sin(3*t)\n");
    put(&s->made, "vsource V in 0 2 + sin(3*t)\n");
    if (member_one_of(member, 3) == 0) {
        put(&s->flat, "tree absolute\n");
        put(&s->made, "tree absolute\n");
    }
}

/* --- the comparison --- */

static bool agree(Member *member, Kit *a, const char *first, Kit *b, const char *second,
                  double bound)
{
    const double x = kit_value(a, first), y = kit_value(b, second);

    if (isnan(x) || isnan(y)) {
        tell(member, "%s %g, %s %g: %s\n", first, x, second, y, b->error.message);
        return false;
    }
    return keeps(member, second, fabs(x - y), bound * (1 + fabs(x)));
}

static bool same_equations(Member *member, Kit *a, Kit *b)
{
    int n = 0; /* speeds: Euler parameters are more than these */
    bool same = agree(member, a, "model.n", b, "model.n", 1e-15) &&
                agree(member, a, "model.m", b, "model.m", 1e-15);
    char entry[40];

    do
        (void)snprintf(entry, sizeof entry, "forces(%d)", ++n);
    while (!isnan(kit_value(a, entry)));
    same = same && isnan(kit_value(b, entry)) && n > 1;
    for (int i = 1; i < n && same; i++) {
        (void)snprintf(entry, sizeof entry, "forces(%d)", i);
        same = agree(member, a, entry, b, entry, 1e-11);
        for (int k = 1; k < n && same; k++) {
            (void)snprintf(entry, sizeof entry, "mass(%d,%d)", i, k);
            same = agree(member, a, entry, b, entry, 1e-11);
        }
    }
    return same;
}

static bool same_motion(Member *member, const Narrative *s, Kit *a, Kit *b)
{
    static const char *const asked[] = {"h", "h'", "tip.x", "h.fx", "height", "b.vy"};
    bool same = true;

    for (int i = 0; i < s->uses; i++)
        for (int k = 0; k < (int)(sizeof asked / sizeof asked[0]) && same; k++) {
            char first[40], second[40];

            (void)snprintf(first, sizeof first, "u%d_%s", i, asked[k]);
            (void)snprintf(second, sizeof second, "u%d.%s", i, asked[k]);
            same = agree(member, a, first, b, second, 1e-8);
            if (same && s->used[i].module->inner >= 0) {
                (void)snprintf(first, sizeof first, "u%d_i_%s", i, asked[k]);
                (void)snprintf(second, sizeof second, "u%d.i.%s", i, asked[k]);
                same = agree(member, a, first, b, second, 1e-8);
            }
        }
    return same && agree(member, a, "energy.total", b, "energy.total", 1e-8);
}

static bool runs(Member *member, Kit *kit, const char *text)
{
    if (kit_do(kit, text) == CT_OK)
        return true;
    tell(member, "%d:%d: %s\n%s\n", kit->error.line, kit->error.column, kit->error.message,
         kit->error.inside);
    return false;
}

/* undo all and do it again; or what save wrote */
static bool again(Member *member, Kit *made, Kit *out, bool undo)
{
    int steps = 0;
    char *text;
    bool done;

    if (undo) {
        while (ct_undo(made->session, &made->error) == CT_OK)
            steps++;
        while (steps-- > 0)
            if (ct_redo(made->session, &made->error) != CT_OK) {
                tell(member, "redo: %s\n", made->error.message);
                return false;
            }
    }
    text = ct_save(made->session);
    done = runs(member, out, text);
    if (!done || member->told)
        tell(member, "saved:\n%s\n", text);
    ct_free(text);
    return done;
}

static Verdict parts_and_subsystems_agree(Member *member)
{
    static const char run[] = "simulate 0.3 every=0.3 rtol=1e-10 atol=1e-11\n";
    static Narrative s;
    Kit flat = kit_new(), made = kit_new(), saved = kit_new();
    bool same, stands = false; /* a run that meets a singular position may be refused */

    draw_story(member, &s);
    same = runs(member, &flat, s.flat.text) && runs(member, &made, s.made.text) &&
           same_equations(member, &flat, &made) &&
           again(member, &made, &saved, member->number % 2 == 0) &&
           same_equations(member, &flat, &saved);
    if (same && kit_do(&flat, run) == CT_OK)
        stands = same = runs(member, &saved, run) && same_motion(member, &s, &flat, &saved);
    if (!same || member->told)
        tell(member, "--- flat\n%s--- made\n%s", s.flat.text, s.made.text);
    kit_free(&flat);
    kit_free(&made);
    kit_free(&saved);
    return !same ? DISAGREES : stands ? AGREES : REFUSED;
}

/* --- robots of many legs --- */

enum { LEGS = 12 };

typedef struct Robot {
    Writer flat, made;
    int legs;
} Robot;

/* A leg of two links from `a`; in the one model inside a definition, in the other with a prefix. */
static void put_leg(Writer *w, const char *p, const char *a, double l1, double l2)
{
    put(w, "%sL1 = %.15g\n%sL2 = %.15g\n", p, l1, p, l2);
    put(w, "body %sb1 mass=3 inertia=0.04\nbody %sb2 mass=4 inertia=0.12\n", p, p);
    put(w, "arm %sa1 %sb1 [-%sL1/2, 0]\narm %sk1 %sb1 [%sL1/2, 0.02]\n", p, p, p, p, p, p);
    put(w, "arm %sk2 %sb2 [-%sL2/2, 0]\narm %sB %sb2 [%sL2/2, 0]\n", p, p, p, p, p, p);
    put(w, "revolute %sth1 %s %sa1\nrevolute %sth2 %sk1 %sk2\n", p, a, p, p, p, p);
    put(w, "damper %sd %sth2 d=0.3\nspring %ss %s %sB k=20 length=0.4\n", p, p, p, a, p);
    put(w, "motor %sM %sth1 %su 0 R=1 L=0.1 Kt=1 Kv=1\nresistor %sR %su 0 5\n", p, p, p, p, p);
}

/* Where a leg stands, so that its tip is at the pin: another tree now and then, other lengths. */
static void put_standing(Member *member, Robot *r, int i, bool moves)
{
    const double l1 = member_between(member, 0.3, 0.5), l2 = member_between(member, 0.4, 0.7);
    const double th1 = member_between(member, -3, 3), th2 = member_between(member, 0.5, 2.5);
    const double at = 2 * M_PI * i / r->legs;
    /* the knee's offset of 0.02 stands across the first link */
    const double x = 0.3 * cos(at) - l1 * cos(th1) + 0.02 * sin(th1) - l2 * cos(th1 + th2);
    const double y = 0.3 * sin(at) - l1 * sin(th1) - 0.02 * cos(th1) - l2 * sin(th1 + th2);
    const char *base = moves ? "cart" : "ground";
    char prefix[20], place[20];
    Writer both = {.length = 0};

    (void)snprintf(prefix, sizeof prefix, "leg%d_", i);
    (void)snprintf(place, sizeof place, "g%d", i);
    put(&both, "arm g%d %s [%.17g, %.17g]\narm p%d m [%.17g, %.17g]\n", i, base, x, y, i,
        0.3 * cos(at), 0.3 * sin(at));
    put(&r->flat, "%s", both.text);
    put(&r->made, "%s", both.text);
    put_leg(&r->flat, prefix, place, l1, l2);
    put(&r->made, "use leg leg%d A=g%d L1=%.15g L2=%.15g\n", i, i, l1, l2);
    put(&r->flat, "revolute h%d leg%d_B p%d\nguess leg%d_th1 = %.17g, leg%d_th2 = %.17g\n", i, i, i,
        i, th1, i, th2);
    put(&r->made, "revolute h%d leg%d.B p%d\nguess leg%d.th1 = %.17g, leg%d.th2 = %.17g\n", i, i, i,
        i, th1, i, th2);
}

static void draw_robot(Member *member, Robot *r)
{
    const bool moves = member_one_of(member, 2) == 0;
    const int strange = member_one_of(member, 3) == 0 ? 0 : -1;

    memset(r, 0, sizeof *r);
    r->legs = 2 + member_one_of(member, LEGS - 1);
    put(&r->flat, "scene planar\ngravity [0, -9.81]\n");
    if (moves)
        put(&r->flat, "body cart mass=9 inertia=2\nplanarjoint c ground cart\n"
                      "init c.s1' = 0.3, c.theta' = 0.2\n");
    put(&r->flat, "body m mass=8 inertia=0.08\n");
    put(&r->made, "%ssubsystem leg frames=[A, B]\n", r->flat.text);
    put_leg(&r->made, "", "A", 0.4, 0.5);
    put(&r->made, "end\n");
    for (int i = 0; i < r->legs; i++)
        put_standing(member, r, i, moves);
    put(&r->flat, "init m.x = 0, m.y = 0, m.theta = 0, m.vx = 0.3, m.vy = -0.2, m.wz = 0.5\n");
    put(&r->made, "init m.x = 0, m.y = 0, m.theta = 0, m.vx = 0.3, m.vy = -0.2, m.wz = 0.5\n");
    for (int k = 0; k < 2; k++) {
        Writer *w = k == 0 ? &r->flat : &r->made;
        const char *dot = k == 0 ? "_" : ".";

        put(w, "tree m%s", moves ? " c" : "");
        for (int i = 0; i < r->legs; i++)
            if (i == strange) /* reached from the platform */
                put(w, " h%d leg%d%sth2", i, i, dot);
            else
                put(w, " leg%d%sth1 leg%d%sth2", i, dot, i, dot);
        put(w, "\n");
    }
}

static bool same_robots(Member *member, const Robot *r, Kit *flat, Kit *made)
{
    bool same = same_equations(member, flat, made);
    char first[60], second[60];

    for (int i = 0; i < r->legs && same; i++) {
        static const char *const asked[] = {"th1'", "b2.x", "th2.fy", "th1.fx", "M.i"};

        for (int k = 0; k < (int)(sizeof asked / sizeof asked[0]) && same; k++) {
            (void)snprintf(first, sizeof first, "leg%d_%s", i, asked[k]);
            (void)snprintf(second, sizeof second, "leg%d.%s", i, asked[k]);
            same = agree(member, flat, first, made, second, 1e-8);
        }
        for (int k = 1; k <= 2 * r->legs && same; k++) {
            (void)snprintf(first, sizeof first, "jacobian(%d,%d)", k, 1 + i);
            same = agree(member, flat, first, made, first, 1e-10);
        }
    }
    return same;
}

static Verdict legs_are_derived_alike(Member *member)
{
    static Robot r;
    Kit flat = kit_new(), made = kit_new();
    bool same;

    draw_robot(member, &r);
    same = runs(member, &flat, r.flat.text) && runs(member, &made, r.made.text) &&
           same_robots(member, &r, &flat, &made);
    if (!same || member->told)
        tell(member, "--- flat\n%s--- made\n%s", r.flat.text, r.made.text);
    kit_free(&flat);
    kit_free(&made);
    return same ? AGREES : DISAGREES;
}

/* --- spatial legs below a platform, closed by joints of any rows --- */

enum { STRUTS = 4 };

/* from `a` along a universal joint's and a slide's own way */
static void put_strut(Writer *w, const char *p, const char *a)
{
    put(w, "%sL = 0.3\nbody %sb1 mass=1 inertia=[0.04, 0.05, 0.06]\n", p, p);
    put(w, "body %sb2 mass=0.8 inertia=[0.02, 0.03, 0.05]\n", p);
    put(w, "arm %sk %sb1 [%sL, 0.01, 0]\narm %sB %sb2 [%sL, 0, 0]\n", p, p, p, p, p, p);
    put(w, "universal %sth %s %sb1 axes=[y, z]\n", p, a, p);
    put(w, "prismatic %ss %sk %sb2 axis=x\n", p, p, p);
    put(w, "spring %ssp %ss k=100 rest=0.2\ndamper %sd %ss d=2\n", p, p, p, p);
}

/* what is 0 for one leg needn't be for another */
static double often_zero(Member *member, double size)
{
    return member_one_of(member, 3) == 0 ? 0 : member_between(member, -size, size);
}

/* Its base so that its tip is near its pin: assembly does what is left. */
static void put_closed(Member *member, Robot *r, int i, const char *base, const char *closing,
                       bool swapped)
{
    const double a = member_between(member, -0.4, 0.4), b = member_between(member, -0.4, 0.4);
    const double s = member_between(member, 0.1, 0.5), l = 0.6 + s;
    const bool straight = member_one_of(member, 3) == 0;
    const double p[3] = {often_zero(member, 0.3), often_zero(member, 0.3), often_zero(member, 0.3)};
    Writer both = {.length = 0};

    put(&both, "arm p%d m [%.17g, %.17g, %.17g]\n", i, p[0], p[1], p[2]);
    if (straight)
        put(&both, "arm g%d %s [%.17g, %.17g, %.17g]\n", i, base, p[0] - l, p[1], p[2]);
    else
        put(&both, "arm g%d %s [%.17g, %.17g, %.17g]\n", i, base, p[0] - l * cos(a) * cos(b),
            p[1] - l * sin(b), p[2] + l * sin(a) * cos(b));
    for (int k = 0; k < 2; k++) {
        Writer *w = k == 0 ? &r->flat : &r->made;
        const char dot = k == 0 ? '_' : '.';
        char prefix[20], place[20], tip[20], pin[20];

        (void)snprintf(prefix, sizeof prefix, "leg%d_", i);
        (void)snprintf(place, sizeof place, "g%d", i);
        (void)snprintf(tip, sizeof tip, "leg%d%cB", i, dot);
        (void)snprintf(pin, sizeof pin, "p%d", i);
        put(w, "%s", both.text);
        if (k == 0)
            put_strut(w, prefix, place);
        else
            put(w, "use strut leg%d A=g%d\n", i, i);
        put(w, "%s h%d %s %s\n", closing, i, swapped ? pin : tip, swapped ? tip : pin);
        put(w, "guess leg%d%cs = %.17g, leg%d%cth.a1 = %.17g, leg%d%cth.a2 = %.17g\n", i, dot, s, i,
            dot, straight ? 0 : a, i, dot, straight ? 0 : b);
    }
}

static void draw_platform(Member *member, Robot *r)
{
    static const char *const closings[] = {"spherical", "universal", "cylindrical"};
    const char *closing = closings[member_one_of(member, 3)];
    const bool moves = member_one_of(member, 3) == 0, swapped = member_one_of(member, 2) == 0;

    memset(r, 0, sizeof *r);
    r->legs = 2 + member_one_of(member, strcmp(closing, "spherical") == 0 ? STRUTS : 2);
    put(&r->flat, "gravity [0, 0, -9.81]\n");
    if (moves)
        put(&r->flat, "body cart mass=9 inertia=[2, 2, 2]\nprismatic c ground cart axis=x\n"
                      "init c' = 0.3\n");
    put(&r->flat, "body m mass=8 inertia=[0.1, 0.2, 0.3]\nguess m.x = 0, m.y = 0, m.z = 0\n");
    put(&r->made, "%ssubsystem strut frames=[A, B]\n", r->flat.text);
    put_strut(&r->made, "", "A");
    put(&r->made, "end\n");
    for (int i = 0; i < r->legs; i++)
        put_closed(member, r, i, moves ? "cart" : "ground", closing, swapped);
    for (int k = 0; k < 2; k++) {
        Writer *w = k == 0 ? &r->flat : &r->made;

        put(w, "tree m%s", moves ? " c" : "");
        for (int i = 0; i < r->legs; i++)
            put(w, k == 0 ? " leg%d_th leg%d_s" : " leg%d.th leg%d.s", i, i);
        put(w, "\n");
    }
}

static bool same_platforms(Member *member, const Robot *r, Kit *flat, Kit *made)
{
    static const char *const asked[] = {"s", "s''", "th.a1'", "s.Ty", "th.fx", "b2.z"};
    const int rows = (int)kit_value(flat, "model.m"), columns = 6 + 3 * r->legs;
    bool same = same_equations(member, flat, made);
    char first[60], second[60];

    for (int i = 0; i < r->legs && same; i++)
        for (int k = 0; k < (int)(sizeof asked / sizeof asked[0]) && same; k++) {
            (void)snprintf(first, sizeof first, "leg%d_%s", i, asked[k]);
            (void)snprintf(second, sizeof second, "leg%d.%s", i, asked[k]);
            same = agree(member, flat, first, made, second, 1e-8);
        }
    for (int k = 1; k <= rows && same; k++)
        for (int j = 1; j <= columns && same; j++) {
            (void)snprintf(first, sizeof first, "jacobian(%d,%d)", k, j);
            same = agree(member, flat, first, made, first, 1e-8);
        }
    return same;
}

static Verdict platforms_are_derived_alike(Member *member)
{
    static const char run[] = "simulate 0.05 every=0.05 rtol=1e-10 atol=1e-11\n";
    static Robot r;
    Kit flat = kit_new(), made = kit_new();
    bool same, stands = false;

    draw_platform(member, &r);
    same = runs(member, &flat, r.flat.text) && runs(member, &made, r.made.text);
    if (same && kit_do(&flat, run) == CT_OK)
        stands = same = runs(member, &made, run);
    same = same && (!stands || same_platforms(member, &r, &flat, &made));
    if (!same || member->told)
        tell(member, "--- flat\n%s--- made\n%s", r.flat.text, r.made.text);
    kit_free(&flat);
    kit_free(&made);
    return !same ? DISAGREES : stands ? AGREES : REFUSED;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"parts_and_subsystems_agree", 4, 0.05, 0, parts_and_subsystems_agree},
        {"legs_are_derived_alike", 3, 0, 0, legs_are_derived_alike},
        {"platforms_are_derived_alike", 3, 1, 0, platforms_are_derived_alike},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
