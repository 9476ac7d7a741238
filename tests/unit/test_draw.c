/* the mechanism as a picture: places to scale, parts by their kind, films that stand alone */
#include "session_kit.h"

#define CRANK                                                                                      \
    "title \"Crank & <rod>\"\nscene planar\ngravity [0, -9.81]\n"                                  \
    "body m1 mass=1 inertia=0.01\nbody m2 mass=1.5 inertia=0.03\nbody m3 mass=2 inertia=0.01\n"    \
    "arm r4 m1 [-0.1, 0]\narm r5 m1 [0.1, 0]\narm r6 m2 [0.25, 0]\narm r7 m2 [-0.25, 0]\n"         \
    "revolute h8 ground r4\nrevolute h9 r5 r6\nrevolute h10 m3 r7\n"                               \
    "prismatic s11 ground m3 axis=x\nforce F12 m3 [-5, 2*t]\ninit h8 = 50 deg, h8' = 10\n"

/* the drawing of a line, as a format; "" and a fault where it fails */
static char *drawn(Kit *kit, const char *line, const char *format)
{
    char *text = NULL;

    EXPECT_TEXT(kit_draw(kit, line, format, &text) == CT_OK ? "" : kit->error.message, "");
    return text != NULL ? text : calloc(1, 1);
}

/* where the group of a part begins */
static const char *part(const char *svg, const char *name)
{
    char title[64];
    const char *at;

    (void)snprintf(title, sizeof title, "<title>%s</title>", name);
    at = strstr(svg, title);
    EXPECT_TEXT(at != NULL ? "" : name, "");
    return at != NULL ? at : svg + strlen(svg);
}

static void circle(const char *svg, const char *name, double out[2])
{
    const char *at = strstr(part(svg, name), "<circle cx=\"");

    out[0] = out[1] = NAN;
    EXPECT(at != NULL && sscanf(at, "<circle cx=\"%lf\" cy=\"%lf\"", &out[0], &out[1]) == 2);
}

/* the first two points of a part's first line or area */
static void points(const char *svg, const char *name, double out[4])
{
    const char *at = strstr(part(svg, name), "points=\"");

    EXPECT(at != NULL &&
           sscanf(at, "points=\"%lf,%lf %lf,%lf", &out[0], &out[1], &out[2], &out[3]) == 4);
}

static int count_of(const char *text, const char *what)
{
    int count = 0;

    for (; (text = strstr(text, what)) != NULL; text += strlen(what))
        count++;
    return count;
}

/* px a metre, by the bar below: its second and third point are its ends */
static double scale_of(const char *svg)
{
    const char *at = strstr(part(svg, "scale of lengths and forces"), "points=\"");
    const char *text = strstr(at, "</text>");
    double low = 0, high = 0, y = 0, length;

    EXPECT(sscanf(at, "points=\"%*f,%*f %lf,%lf %lf,%*f", &low, &y, &high) == 3);
    while (text[-1] != '>')
        text--;
    length = strtod(text, NULL);
    EXPECT(strstr(text, " m<") != NULL || strstr(text, " mm<") != NULL);
    return (high - low) / (strncmp(strchr(text, ' '), " mm", 3) == 0 ? length / 1000 : length);
}

/* by hand: the crank's pin is 0.2 m from the main bearing, at 50 degrees; the piston on the axis */
static void places_are_to_scale(void)
{
    Kit kit = kit_new();
    char *svg;
    double h8[2] = {0}, h9[2] = {0}, h10[2] = {0}, scale;
    const double angle = 50 * M_PI / 180, pin = 0.2;

    EXPECT_DONE(&kit, CRANK);
    svg = drawn(&kit, "draw mechanism", "svg");
    scale = scale_of(svg);
    circle(svg, "revolute h8", h8);
    circle(svg, "revolute h9", h9);
    circle(svg, "revolute h10", h10);
    EXPECT_NEAR((h9[0] - h8[0]) / scale, pin * cos(angle), 5e-4);
    EXPECT_NEAR((h8[1] - h9[1]) / scale, pin * sin(angle), 5e-4);
    EXPECT_NEAR(fabs(h10[0] - h9[0]) / scale, sqrt(0.25 - pin * pin * sin(angle) * sin(angle)),
                5e-4);
    EXPECT_NEAR(h10[1], h8[1], 0.11);
    ct_free(svg);
    kit_free(&kit);
}

/* a wheel's rim, 0.3 m from its centre, begins at its spoke, which turns with it */
static void wheels_are_to_scale_and_turn(void)
{
    Kit kit = kit_new();
    char *svg;
    double rim[4] = {0}, hub[2] = {0}, scale;

    EXPECT_DONE(&kit, "scene planar\nbody w mass=1 inertia=0.02\narm m w [1, 0]\n"
                      "roll r ground w radius=0.3\ninit w.theta = 0.5\n");
    svg = drawn(&kit, "draw mechanism", "svg");
    scale = scale_of(svg);
    circle(svg, "body w", hub);
    points(svg, "roll r", rim);
    EXPECT_NEAR((rim[0] - hub[0]) / scale, 0.3 * cos(0.5), 2e-3);
    EXPECT_NEAR((hub[1] - rim[1]) / scale, 0.3 * sin(0.5), 2e-3);
    ct_free(svg);
    kit_free(&kit);
}

/* a rod from eye to eye; a coupling and a bushing at their frames */
static void rods_couplings_and_bushings_are_drawn(void)
{
    Kit kit = kit_new();
    char *svg;
    double rod[4] = {0}, ring[2] = {0}, coupling[2] = {0}, scale;

    EXPECT_DONE(&kit, "body w mass=1 inertia=[1, 1, 1]\narm m w [1, 0, 0]\narm p ground [0, 1, 0]\n"
                      "link L p m length=sqrt(2)\nbushing k ground w k=[1, 1, 1, 1, 1, 1]\n"
                      "constvel c ground m\n");
    svg = drawn(&kit, "draw mechanism view=xy", "svg");
    scale = scale_of(svg);
    points(svg, "link L", rod);
    circle(svg, "bushing k", ring);
    circle(svg, "constvel c", coupling);
    EXPECT_NEAR((rod[2] - rod[0]) / scale, 1, 5e-3);
    EXPECT_NEAR((rod[3] - rod[1]) / scale, 1, 5e-3);
    EXPECT_NEAR((coupling[0] - ring[0]) / scale, 1, 5e-3);
    EXPECT_NEAR(coupling[1], ring[1], 0.11);
    ct_free(svg);
    kit_free(&kit);
}

static void every_part_is_drawn_once_by_its_name(void)
{
    static const char *const parts[] = {"body m1",       "body m2",     "body m3",
                                        "revolute h8",   "revolute h9", "revolute h10",
                                        "prismatic s11", "force F12"};
    Kit kit = kit_new();
    char *svg;

    EXPECT_DONE(&kit, CRANK);
    svg = drawn(&kit, "draw mechanism", "svg");
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        char title[64];

        (void)snprintf(title, sizeof title, "<title>%s</title>", parts[i]);
        EXPECT(count_of(svg, title) == 1);
    }
    EXPECT_HOLDS(svg, "Crank &amp; &lt;rod&gt;");
    EXPECT_HOLDS(svg, "t = 0 s");
    EXPECT(strstr(svg, "reaction") == NULL);
    ct_free(svg);
    svg = drawn(&kit, "draw mechanism reactions=on", "svg");
    EXPECT(count_of(svg, "<title>reaction h9</title>") == 1);
    ct_free(svg);
    kit_free(&kit);
}

/* F12 is (-5, 2 t) N: at 1 s it points down the axis and up, as 5 to 2 */
static void forces_are_to_scale_and_of_the_instant(void)
{
    Kit kit = kit_new();
    char *svg;
    double arrow[4] = {0};

    EXPECT_DONE(&kit, CRANK "simulate 1 every=0.1");
    svg = drawn(&kit, "draw mechanism at 1", "svg");
    EXPECT_HOLDS(svg, "t = 1 s");
    points(svg, "force F12", arrow);
    EXPECT_NEAR((arrow[1] - arrow[3]) / (arrow[0] - arrow[2]), 0.4, 5e-3);
    ct_free(svg);
    kit_free(&kit);
}

/* the least distance of a place to a clamped beam of 1 m with 9 N at its end, EI = 20 N m^2, as
 * books have it: y = -F x^2 (3 L - x)/(6 EI) */
static double distance_to_cantilever(double x, double y)
{
    double least = INFINITY;

    for (int i = 0; i <= 2000; i++) {
        const double at = i / 2000.0;

        least = fmin(least, hypot(x - at, y + 9 * at * at * (3 - at) / 120));
    }
    return least;
}

/* All of a bent beam's outline lies half a link's width, 7 px, from the line of its closed form,
 * though the clamp is turned; arrows at its root and end tell where these are. */
static void beams_are_drawn_bent(void)
{
    static const char *const scenes[][2] = {
        {"scene planar\narm c ground [0.2, 0.1] rotation=z(30 deg)\n"
         "beam b length=1 mass_per_length=1 EIz=20 modes=[0, 3] stiffening=off\n"
         "force F tip [sin(30 deg)*9, -cos(30 deg)*9]\nforce G b [9, 9]\n",
         "draw mechanism"},
        {"arm c ground [0.2, 0.1, 0.3] rotation=z(30 deg)\n"
         "beam b length=1 mass_per_length=1 EIz=20 EIy=30 modes=[0, 3, 3, 0] stiffening=off\n"
         "force F tip [sin(30 deg)*9, -cos(30 deg)*9, 0]\nforce G b [9, 9, 0]\n",
         "draw mechanism view=xy"}};
    const double turn = atan2(-9.0 / 60, 1) + M_PI / 6; /* of the line from root to end */

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();
        double root[4] = {0}, end[4] = {0}, scale, x, y;
        const char *at;
        char *svg, text[512];
        int count = 0, read;

        (void)snprintf(text, sizeof text, "%s", scenes[i][0]);
        *strstr(text, "force") = '\0';
        EXPECT_DONE(&kit, text);
        EXPECT_DONE(&kit, "arm tip b at=1\nweld w c b");
        EXPECT_DONE(&kit, strstr(scenes[i][0], "force"));
        EXPECT_DONE(&kit, "equilibrium");
        svg = drawn(&kit, scenes[i][1], "svg");
        points(svg, "force G", root);
        points(svg, "force F", end);
        scale = hypot(end[0] - root[0], end[1] - root[1]) / hypot(1, 9.0 / 60);
        EXPECT_NEAR(atan2(root[1] - end[1], end[0] - root[0]), turn, 1e-3);
        at = strstr(part(svg, "body b"), "points=\"");
        at = at != NULL ? at + strlen("points=\"") : "";
        for (; sscanf(at, "%lf,%lf%n", &x, &y, &read) == 2; at += read, count++) {
            const double right = (x - root[0]) / scale, up = (root[1] - y) / scale;

            EXPECT_NEAR(scale * distance_to_cantilever(right * cos(M_PI / 6) + up * sin(M_PI / 6),
                                                       up * cos(M_PI / 6) - right * sin(M_PI / 6)),
                        7, 0.3);
        }
        EXPECT(count > 24);
        ct_free(svg);
        kit_free(&kit);
    }
}

/* a bracket beside the axis, and a beam seen from its end, are drawn, too */
static void beams_have_brackets_and_ends(void)
{
    Kit kit = kit_new();
    char *svg;

    EXPECT_DONE(&kit, "beam b length=1 mass_per_length=1 EIz=20 modes=[0, 2, 0, 0]\n"
                      "weld w ground b\narm tip b at=1\narm c tip [0, 0.2, 0]\n"
                      "arm d b [-0.1, 0.1, 0]\nbody m mass=1 inertia=[1, 1, 1]\nweld e c m");
    svg = drawn(&kit, "draw mechanism view=xy", "svg");
    EXPECT(count_of(svg, "<g class=\"body\"><title>body b") == 1);
    EXPECT(count_of(strstr(svg, "<title>body b"), "<polygon") >= 3);
    ct_free(svg);
    svg = drawn(&kit, "draw mechanism view=yz", "svg");
    EXPECT(strstr(svg, "nan") == NULL);
    ct_free(svg);
    kit_free(&kit);
}

/* seen along y, x is to the right and z up; the isometric view has the ground's axes 120 degrees
 * apart, and gravity points down whichever axis it is along */
static void spatial_scenes_are_seen_from_where_they_are_asked(void)
{
    static const char ball[] = "body b mass=1 inertia=[1, 1, 1]\narm a b [0.3, 0.4, -0.5]\n"
                               "arm c ground [0.1, 0.2, 0]\nspherical j c b\n";
    Kit kit = kit_new();
    char *svg;
    double arrow[4] = {0};

    EXPECT_DONE(&kit, ball);
    EXPECT_DONE(&kit, "gravity [0, -9.81, 0]");
    svg = drawn(&kit, "draw mechanism", "svg");
    points(svg, "gravity of the scene", arrow);
    EXPECT_NEAR(arrow[2], arrow[0], 0.05);
    EXPECT(arrow[3] > arrow[1]);
    ct_free(svg);
    svg = drawn(&kit, "draw mechanism view=xz", "svg");
    EXPECT(strstr(svg, "gravity") == NULL); /* end on */
    EXPECT_HOLDS(svg, ">x</text>");
    EXPECT_HOLDS(svg, ">z</text>");
    EXPECT(strstr(svg, ">y</text>") == NULL);
    ct_free(svg);
    EXPECT(kit_do(&kit, "draw mechanism view=up") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "iso, xy, xz, yz");
    kit_free(&kit);
}

/* joints are told by what they leave free, springs by what they do */
static void every_kind_of_part_has_a_picture(void)
{
    static const char *const joints[] = {"revolute",  "prismatic", "cylindrical", "universal",
                                         "spherical", "weld",      "planarjoint"};
    Kit kit = kit_new();

    for (size_t i = 0; i < sizeof joints / sizeof joints[0]; i++) {
        char text[256], name[32];
        char *svg;

        (void)snprintf(text, sizeof text,
                       "clear\nbody b mass=1 inertia=[1, 1, 1]\n%s j ground b\n"
                       "arm w ground [1, 1, 0]\narm e b [0.2, 0, 0]\nspring k w e k=1\n"
                       "damper d w b d=1\nactuator a w e force=2",
                       joints[i]);
        EXPECT_DONE(&kit, text);
        svg = drawn(&kit, "draw mechanism", "svg");
        (void)snprintf(name, sizeof name, "%s j", joints[i]);
        EXPECT(*part(svg, name) != '\0');
        EXPECT(*part(svg, "spring k") != '\0');
        EXPECT(*part(svg, "damper d") != '\0');
        EXPECT(*part(svg, "actuator a") != '\0');
        ct_free(svg);
    }
    kit_free(&kit);
}

static char *film(Kit *kit, const char *line, const char *format, int *count, double *interval)
{
    ct_cursor cursor = {.text = line, .line = 1};
    ct_paper paper = {.format = format, .columns = 60, .rows = 20};
    ct_statement *statement = NULL;
    char **frames = NULL;
    char *first = NULL;

    EXPECT(ct_parse(&cursor, false, &statement, &kit->error) == CT_OK);
    EXPECT_TEXT(ct_animate(kit->session, statement, &paper, &frames, interval, &kit->error) == CT_OK
                    ? ""
                    : kit->error.message,
                "");
    *count = 0;
    for (int i = 0; frames != NULL && frames[i] != NULL; i++) {
        if (i == 0)
            first = frames[i];
        else
            ct_free(frames[i]);
        (*count)++;
    }
    ct_free(frames);
    ct_statement_free(statement);
    return first != NULL ? first : calloc(1, 1);
}

/* nothing from outside: no address, no style or script of another file */
static void a_page_plays_by_itself(void)
{
    Kit kit = kit_new();
    int count;
    double interval;
    char *page;

    EXPECT_DONE(&kit, CRANK "simulate 2 every=0.01");
    page = film(&kit, "animate to=1 speed=0.5", "html", &count, &interval);
    EXPECT(count == 1);
    EXPECT(count_of(page, "class=\"frame\"") == 50); /* two seconds, 25 pictures in each */
    EXPECT(strstr(page, "http") == NULL && strstr(page, "src=") == NULL &&
           strstr(page, "href=") == NULL && strstr(page, "@import") == NULL);
    EXPECT_HOLDS(page, "const seconds = 2, times = [0,");
    EXPECT_HOLDS(page, "Crank &amp; &lt;rod&gt;");
    EXPECT_NEAR(interval, 0.04, 1e-9);
    ct_free(page);
    page = film(&kit, "animate run1 from=0.5 to=1.5", "svg", &count, &interval);
    EXPECT(count_of(page, "<animate ") == 25 && count_of(page, "class=\"frame\"") == 25);
    EXPECT_HOLDS(page, "t = 0.5 s");
    EXPECT_HOLDS(page, "t = 1.5 s");
    ct_free(page);
    page = film(&kit, "animate to=1", "text", &count, &interval);
    EXPECT(count == 8);
    ct_free(page);
    kit_free(&kit);
}

#define TWO_TREES "tree translation h8 h9 h10\ntree rotation h8 h10 s11\n"

/* branches of both trees, by hand: each has the four arms and its three joints */
typedef struct Written {
    double x, y, width, height; /* left bottom corner */
    char text[16];
} Written;

/* the names of a frame, those with a halo; as wide as letters are */
static int read_names(const char *from, const char *to, Written *out, int most)
{
    int count = 0;

    for (const char *at = from; (at = strstr(at, "<text ")) != NULL && at < to; at++) {
        double size;
        Written *name = &out[count];

        if (sscanf(at, "<text x=\"%lf\" y=\"%lf\" font-size=\"%lf\"", &name->x, &name->y, &size) !=
            3)
            continue;
        if (sscanf(strchr(at, '>'), ">%15[a-zA-Z0-9]<", name->text) != 1 || count == most - 1 ||
            strlen(name->text) > 3)
            continue;
        name->width = 0.5 * size * (double)strlen(name->text);
        name->height = 0.7 * size;
        count++;
    }
    return count;
}

static bool cover(const Written *a, const Written *b)
{
    return a->x < b->x + b->width && b->x < a->x + a->width && a->y - a->height < b->y &&
           b->y - b->height < a->y;
}

/* in no instant more than a few, and never those of one point all the time */
static void names_in_a_film_stand_apart(void)
{
    enum { MOST = 20 };
    Kit kit = kit_new();
    double interval = 0;
    int frames = 0, covered = 0, names = 0, count = 0;
    char *page;

    EXPECT_DONE(&kit, CRANK "guess h10 = 2.5\nsimulate 2\n");
    page = film(&kit, "animate", "svg", &count, &interval);
    for (const char *at = page; (at = strstr(at, "class=\"frame\"")) != NULL; frames++) {
        Written name[MOST];
        const char *next = strstr(++at, "class=\"frame\"");
        const int found = read_names(at, next != NULL ? next : at + strlen(at), name, MOST);
        bool is_covered = false;

        for (int i = 0; i < found; i++)
            for (int k = 0; k < i; k++)
                is_covered = is_covered || cover(&name[i], &name[k]);
        covered += is_covered;
        names += found;
    }
    EXPECT(frames > 20 && names >= 7 * frames);
    if (covered * 10 > frames) {
        test_faults++;
        printf("names cover one another in %d of %d frames\n", covered, frames);
    }
    ct_free(page);
    kit_free(&kit);
}

static void trees_stand_side_by_side_where_they_differ(void)
{
    Kit kit = kit_new();
    char *svg;

    EXPECT_DONE(&kit, CRANK "tree h8 h10 s11");
    svg = drawn(&kit, "draw", "svg");
    EXPECT_HOLDS(svg, "mechanical tree");
    EXPECT(count_of(svg, "<g class=\"branch\">") == 7);
    EXPECT(count_of(svg, "<g class=\"chord\">") == 5); /* m1 m2 m3 h9 F12 */
    EXPECT(count_of(svg, "<g class=\"node\">") == 8);
    EXPECT(count_of(svg, "stroke-width=\"10\"") == 0);
    ct_free(svg);
    EXPECT_DONE(&kit, TWO_TREES);
    svg = drawn(&kit, "draw", "svg");
    EXPECT_HOLDS(svg, "translation tree");
    EXPECT_HOLDS(svg, "rotation tree");
    EXPECT(count_of(svg, "<g class=\"branch\">") == 14);
    EXPECT(count_of(svg, "<title>branch h9</title>") == 1);
    EXPECT(count_of(svg, "<title>chord h9</title>") == 1);
    ct_free(svg);
    kit_free(&kit);
}

/* the loop of the crank is one circuit, whose joints and arms are all lit; the cutset of h8 parts
 * the crank from ground: m1 and, at its pin, h9 leave with it. Once more in the legend. */
static void circuits_and_cutsets_are_lit(void)
{
    Kit kit = kit_new();
    char *svg;

    EXPECT_DONE(&kit, CRANK "tree h8 h10 s11");
    svg = drawn(&kit, "draw circuit h9", "svg");
    EXPECT(count_of(svg, "stroke-width=\"10\"") == 8 + 1);
    ct_free(svg);
    svg = drawn(&kit, "draw cutset h8", "svg");
    EXPECT(count_of(svg, "stroke-width=\"10\"") == 3 + 1);
    ct_free(svg);
    EXPECT(kit_do(&kit, "draw circuit h8") == CT_FAILED);
    EXPECT_HOLDS(kit.error.hint, "draw cutset h8");
    EXPECT(kit_do(&kit, "draw cutset h9") == CT_FAILED);
    EXPECT_HOLDS(kit.error.hint, "draw circuit h9");
    EXPECT(kit_do(&kit, "draw circuit h99") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "h99");
    EXPECT(kit_do(&kit, "draw circuit") == CT_FAILED);

    /* h9 is a chord of the rotation tree alone: that one is shown */
    EXPECT_DONE(&kit, TWO_TREES);
    svg = drawn(&kit, "draw circuit h9", "svg");
    EXPECT(strstr(svg, "translation tree") == NULL);
    EXPECT_HOLDS(svg, "rotation tree");
    ct_free(svg);
    kit_free(&kit);
}

/* domains by colour and dash, each with its legend; nodes that no edge joins stay apart */
static void each_domain_has_its_colour_and_dash(void)
{
    Kit kit = kit_new();
    char *svg;

    EXPECT_DONE(&kit, "scene planar\nbody m mass=1 inertia=1\nrevolute h ground m\n"
                      "vsource E a 0 1\nmotor M h a 0 R=1 L=0.1 Kt=1 Kv=1\ntank T p 0 A=1\n"
                      "pipe P p 0 R=1\n");
    svg = drawn(&kit, "draw", "svg");
    EXPECT_HOLDS(svg, "mechanical tree");
    EXPECT_HOLDS(svg, "electrical tree");
    EXPECT_HOLDS(svg, "hydraulic tree");
    EXPECT(count_of(svg, "stroke-dasharray=\"7 4\"") == 3); /* E, M, legend */
    EXPECT(count_of(svg, "stroke-dasharray=\"2 3\"") == 3); /* T, P, legend */
    EXPECT_HOLDS(svg, ">electrical</text>");
    ct_free(svg);
    kit_free(&kit);
}

/* rings of nodes don't lie over one another, whatever the graph: chains, stars, rings */
static void nodes_stand_apart(void)
{
    Kit kit = kit_new();

    for (int kind = 0; kind < 3; kind++) {
        char lines[2000];
        size_t length = 0;
        char *svg;
        double at[64][2];
        int count = 0;

        for (int i = 1; i <= 24; i++)
            length += (size_t)snprintf(lines + length, sizeof lines - length,
                                       "resistor R%d n%d n%d 1\n", i, i,
                                       kind == 0   ? i - 1
                                       : kind == 1 ? 0
                                                   : i % 24 + 1);
        EXPECT_DONE(&kit, "clear\nvsource E n0 0 1\nresistor Z n1 0 1\n");
        EXPECT_DONE(&kit, lines);
        svg = drawn(&kit, "draw", "svg");
        for (const char *c = svg; (c = strstr(c, "<g class=\"node\">")) != NULL; c++) {
            const char *ring = strstr(c, "<circle");

            EXPECT(ring != NULL && count < 64 &&
                   sscanf(ring, "<circle cx=\"%lf\" cy=\"%lf\"", &at[count][0], &at[count][1]) ==
                       2);
            count++;
        }
        EXPECT(count >= 25);
        for (int i = 0; i < count; i++)
            for (int j = 0; j < i; j++)
                EXPECT(hypot(at[i][0] - at[j][0], at[i][1] - at[j][1]) > 20);
        ct_free(svg);
    }
    kit_free(&kit);
}

/* in characters that every terminal has, no line longer than it is wide */
static void a_plain_terminal_gets_plain_characters(void)
{
    Kit kit = kit_new();
    char *text;

    EXPECT_DONE(&kit, CRANK);
    text = drawn(&kit, "draw mechanism", "text");
    for (const char *line = text; *line != '\0';) {
        const size_t length = strcspn(line, "\n");

        EXPECT(length <= 79);
        for (size_t i = 0; i < length; i++)
            EXPECT((unsigned char)line[i] < 0x80);
        line += length + (line[length] == '\n');
    }
    EXPECT_HOLDS(text, "m2");
    EXPECT(count_of(text, ":") > 20);
    ct_free(text);
    kit_free(&kit);
}

static bool drawn_holds(Kit *kit, const char *line, const char *what)
{
    char *svg = drawn(kit, line, "svg");
    const bool holds = strstr(svg, what) != NULL;

    ct_free(svg);
    return holds;
}

/* how far a body's centre is from where it rests, m */
static void moved_in_mode(Kit *kit, const char *line, const char *body, double rest_x,
                          double rest_y, double out[2])
{
    char *svg = drawn(kit, line, "svg");
    const double scale = scale_of(svg);
    double base[2], at[2];

    circle(svg, "body base", base);
    circle(svg, body, at);
    out[0] = (at[0] - base[0]) / scale - rest_x;
    out[1] = (base[1] - at[1]) / scale - rest_y;
    ct_free(svg);
}

/* two masses between three springs: together, and against each other */
static void modes_are_shapes(void)
{
    Kit kit = kit_new();
    double a[2], b[2];

    EXPECT_DONE(&kit, "scene planar\nbody base mass=1 inertia=1\nweld w ground base\n"
                      "body a mass=1 inertia=1\nbody b mass=1 inertia=1\narm pa ground [1, 0]\n"
                      "arm pb ground [2, 0]\nprismatic sa pa a axis=x\n"
                      "prismatic sb pb b axis=x\nspring k1 sa k=1\nspring k2 sb k=1\n"
                      "spring k3 a b k=1 length=1\nbody c mass=1 inertia=1\n"
                      "revolute hc ground c\nspring kc hc k=50");
    moved_in_mode(&kit, "draw mechanism mode=1", "body a", 1, 0, a);
    moved_in_mode(&kit, "draw mechanism mode=1", "body b", 2, 0, b);
    EXPECT_NEAR(fabs(a[0]), 0.15 * 2, 2e-3); /* of the whole, which is 2 m long */
    EXPECT_NEAR(a[0], b[0], 2e-3);
    moved_in_mode(&kit, "draw mechanism mode=2", "body a", 1, 0, a);
    moved_in_mode(&kit, "draw mechanism mode=2", "body b", 2, 0, b);
    EXPECT_NEAR(fabs(a[0]), 0.15 * 2, 2e-3);
    EXPECT_NEAR(a[0], -b[0], 2e-3);
    /* one that only turns is drawn, too */
    EXPECT(drawn_holds(&kit, "draw mechanism mode=3", "mode 3, 7.0711 rad/s"));
    kit_free(&kit);
}

/* a cantilever's first shape: 0.33952 of the tip's way half way along; then in space, and moved */
static void modes_of_beams_are_bent(void)
{
    Kit kit = kit_new();
    double mid[2], tip[2];

    EXPECT_DONE(&kit, "scene planar\nbody base mass=1 inertia=1\nweld w ground base\n"
                      "beam b length=1 mass_per_length=1 EIz=1 modes=[0, 5]\nweld w1 base b\n"
                      "arm am b at=0.5\narm at b at=1\nbody m mass=1e-9 inertia=1e-9\n"
                      "body t1 mass=1e-9 inertia=1e-9\nweld wm am m\nweld wt at t1\n");
    moved_in_mode(&kit, "draw mechanism mode=1", "body m", 0.5, 0, mid);
    moved_in_mode(&kit, "draw mechanism mode=1", "body t1", 1, 0, tip);
    EXPECT_NEAR(fabs(tip[1]), 0.15, 1e-3);
    EXPECT_NEAR(mid[1] / tip[1], 0.33952, 5e-3);
    moved_in_mode(&kit, "draw mechanism mode=2", "body m", 0.5, 0, mid);
    moved_in_mode(&kit, "draw mechanism mode=2", "body t1", 1, 0, tip);
    EXPECT_NEAR(mid[1] / tip[1], -0.71366, 5e-3);
    kit_free(&kit);
}

/* a period in two seconds, of which the page tells the true times; a run's beginning, too */
static void a_mode_is_a_film(void)
{
    Kit kit = kit_new();
    int count;
    double interval;
    char *page;

    EXPECT_DONE(&kit, "body m mass=1 inertia=[1, 1, 1]\nrevolute h ground m axis=x\n"
                      "arm e m [0, 0, 1]\nspring k h k=4\n");
    page = film(&kit, "animate mode=1", "html", &count, &interval);
    EXPECT(count_of(page, "class=\"frame\"") == 50);
    EXPECT_HOLDS(page, "const seconds = 2, times = [0,0.0628319,");
    EXPECT_HOLDS(page, "mode 1, 2 rad/s");
    ct_free(page);
    EXPECT_DONE(&kit, "simulate 1\n");
    page = film(&kit, "animate run1 mode=1", "text", &count, &interval);
    EXPECT(count == 16);
    ct_free(page);
    kit_free(&kit);
}

static void what_cannot_be_drawn_says_why(void)
{
    static const struct {
        const char *line, *says;
    } wrong[] = {
        {"draw mechanism at 9", "9"},
        {"draw mechanism view=xy", "planar"},
        {"draw mechanism reactions=perhaps", "off, on"},
        {"draw mechanism at 1 kg", "s"},
        {"draw m1", "knows no 'm1'"},
        {"draw reactions=on", "draw mechanism"},
        {"draw at 1", "same at all times"},
        {"animate run7", "no such run"},
        {"animate h8", "run2"},
        {"animate from=0.5 to=0.5", "nothing moves"},
        {"animate speed=0", "above 0"},
        {"animate speed=-1", "above 0"},
        {"draw mechanism mode=0", "a whole number from 1 on"},
        {"draw mechanism mode=1.5", "a whole number from 1 on"},
        {"draw mechanism mode=3", "there are 2 modes, counted from 1"},
        {"draw mode=1", "draw mechanism"},
        {"animate mode=3", "there are 2 modes"},
        {"animate mode=1 from=0.5", "through its own period"},
    };
    Kit kit = kit_new();

    EXPECT(kit_do(&kit, "draw mechanism") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "no body");
    EXPECT(kit_do(&kit, "animate") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "no run");
    EXPECT_DONE(&kit, CRANK "simulate 1 every=0.1");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        EXPECT(kit_do(&kit, wrong[i].line) == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, wrong[i].says);
    }

    /* the last run knows no part that came later */
    EXPECT_DONE(&kit, "body m9 mass=1 inertia=1\nrevolute h99 m3 m9");
    EXPECT(kit_do(&kit, "draw mechanism at 0.5") == CT_FAILED);
    EXPECT_HOLDS(kit.error.hint, "simulate");
    EXPECT_DONE(&kit, "draw mechanism");
    kit_free(&kit);
}

int main(void)
{
    RUN(places_are_to_scale);
    RUN(wheels_are_to_scale_and_turn);
    RUN(rods_couplings_and_bushings_are_drawn);
    RUN(every_part_is_drawn_once_by_its_name);
    RUN(forces_are_to_scale_and_of_the_instant);
    RUN(beams_are_drawn_bent);
    RUN(beams_have_brackets_and_ends);
    RUN(spatial_scenes_are_seen_from_where_they_are_asked);
    RUN(every_kind_of_part_has_a_picture);
    RUN(a_page_plays_by_itself);
    RUN(names_in_a_film_stand_apart);
    RUN(trees_stand_side_by_side_where_they_differ);
    RUN(circuits_and_cutsets_are_lit);
    RUN(each_domain_has_its_colour_and_dash);
    RUN(nodes_stand_apart);
    RUN(a_plain_terminal_gets_plain_characters);
    RUN(modes_are_shapes);
    RUN(modes_of_beams_are_bent);
    RUN(a_mode_is_a_film);
    RUN(what_cannot_be_drawn_says_why);
    return test_end();
}
