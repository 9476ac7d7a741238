/* test_expr_units.c: units by name and compound, with factors from the SI brochure */
#include "base/memory.h"
#include "expr/units.h"
#include "test.h"

static void expect_unit(const char *text, double factor, const char *dimension)
{
    Unit unit = {0};
    size_t fault = 999;
    Text printed = {0};
    char *got;

    EXPECT(unit_parse(text, strlen(text), &unit, &fault));
    EXPECT_NEAR(unit.factor, factor, 1e-15 * factor);
    if (unit.den != 0)
        EXPECT_NEAR((double)unit.num / (double)unit.den * pow(M_PI, unit.pi_power), factor,
                    1e-15 * factor);
    dimension_print(&printed, unit.dimension);
    got = text_done(&printed);
    EXPECT_TEXT(got, dimension);
    mem_free(got);
}

static void units_have_their_factors(void)
{
    expect_unit("m", 1, "m");
    expect_unit("mm", 1e-3, "m");
    expect_unit("cm", 1e-2, "m");
    expect_unit("kg", 1, "kg");
    expect_unit("g", 1e-3, "kg");
    expect_unit("ms", 1e-3, "s");
    expect_unit("min", 60, "s");
    expect_unit("deg", M_PI / 180, "rad");
    expect_unit("rpm", M_PI / 30, "rad/s");
    expect_unit("rev", 2 * M_PI, "rad");
    expect_unit("kN", 1e3, "N");
    expect_unit("kohm", 1e3, "ohm");
    expect_unit("kΩ", 1e3, "ohm");
    expect_unit("Mohm", 1e6, "ohm");
    expect_unit("mohm", 1e-3, "ohm");
    expect_unit("uF", 1e-6, "F");
    expect_unit("µF", 1e-6, "F");
    expect_unit("mH", 1e-3, "H");
    expect_unit("mA", 1e-3, "A");
    expect_unit("mAh", 3.6, "C");
    expect_unit("kWh", 3.6e6, "N*m");
    expect_unit("bar", 1e5, "Pa");
    expect_unit("L", 1e-3, "m^3");
    expect_unit("GHz", 1e9, "1/s");
    expect_unit("gn", 9.80665, "m/s^2");
    expect_unit("T", 1, "T");
}

static void compound_units_multiply(void)
{
    expect_unit("kN/m", 1e3, "N/m");
    expect_unit("W/m^2", 1, "W/m^2");
    expect_unit("W/m/K", 1, "W/m/K");
    expect_unit("N*s/m", 1, "kg/s");
    expect_unit("m/s^2", 1, "m/s^2");
    expect_unit("1/s", 1, "1/s");
    expect_unit("kg*m^2", 1, "kg*m^2");
    expect_unit("kg*m/s^2", 1, "N");
    expect_unit(" N * m * s / rad ", 1, "N*m*s/rad");
    expect_unit("s^-1", 1, "1/s");
    expect_unit("km/hour", 1 / 3.6, "m/s");
    expect_unit("deg/s", M_PI / 180, "rad/s");
    expect_unit("N*m/A", 1, "V*s");
    expect_unit("V/m", 1, "V/m");
    expect_unit("mm^2", 1e-6, "m^2");
    expect_unit("1", 1, "1");
    expect_unit("rad/rad", 1, "1");
    expect_unit("W/K", 1, "W/K");
    /* 10^-45 doesn't fit into a ratio: the factor alone counts */
    expect_unit("fm^3", 1e-45, "m^3");
}

static void expect_fault(const char *text, size_t at)
{
    Unit unit;
    size_t fault = 999;

    EXPECT(!unit_parse(text, strlen(text), &unit, &fault));
    EXPECT(fault == at);
}

static void faults_are_located(void)
{
    expect_fault("", 0);
    expect_fault("kgg", 0);
    expect_fault("kN/mx", 3);
    expect_fault("kN/", 3);
    expect_fault("m s", 2);
    expect_fault("m^x", 2);
    expect_fault("m^0.5", 3);
    expect_fault("m^2222222222222222222", 2);
    expect_fault("2/s", 0);
    expect_fault("m^99*m^99", 5);
    expect_fault("N*(m)", 2);
}

static void ambiguous_letters_are_refused(void)
{
    static const char *const none[] = {"t", "h", "d", "k", "u", "x", "cg", "kdeg", "kmin", "mmm"};
    Unit unit;

    for (int i = 0; i < COUNT(none); i++)
        EXPECT(!unit_find(none[i], &unit));
}

static void slips_are_understood(void)
{
    EXPECT_TEXT(unit_suggest("kgg"), "kg");
    EXPECT_TEXT(unit_suggest("kohms"), "kohm");
    EXPECT_TEXT(unit_suggest("Ohm"), "ohm");
    EXPECT_TEXT(unit_suggest("h"), "hour");
    EXPECT_TEXT(unit_suggest("sec"), "s");
    EXPECT_TEXT(unit_suggest("degrees"), "deg");
    EXPECT_TEXT(unit_suggest("KN"), "kN");
    EXPECT(unit_suggest("furlong") == NULL);
}

static void every_unit_is_found_and_is_listed(void)
{
    int count = 0;
    Unit unit;
    Dimension angle = {{0, 0, -1, 0, 0, 1}};
    Dimension rate = {{0, 0, -1, 0, 0, 0}};

    for (; unit_name(count) != NULL; count++) {
        EXPECT(unit_find(unit_name(count), &unit) && unit.factor > 0);
        EXPECT(unit.den != 0);
    }
    EXPECT(count > 30 && unit_name(-1) == NULL);
    EXPECT(dimension_same(angle, rate));
    EXPECT(!dimension_same(angle, (Dimension){{1, 0, -1, 0, 0, 0}}));
}

/* numbers are shown in one unit of a dimension, so that a list has one of each */
static void a_list_has_one_unit_of_a_dimension(void)
{
    static const char *const good[] = {"", "mm", "deg mm rpm", " kN  ms ", "Hz rpm", "kJ Nm"};
    static const char *const wrong[] = {"mm km", "m deg s rad", "J kWh", "mm mm", "mm m/s", "SI"};
    Diag diag;

    for (int i = 0; i < COUNT(good); i++)
        EXPECT(unit_list_check(good[i], &diag) == OK);
    for (int i = 0; i < COUNT(wrong); i++)
        EXPECT(unit_list_check(wrong[i], &diag) == E_UNIT);
    EXPECT(unit_list_check("m deg s rad", &diag) == E_UNIT);
    EXPECT(strstr(diag.message, "deg and rad") != NULL);
    EXPECT(unit_list_check("mm m/s", &diag) == E_UNIT);
    EXPECT(strstr(diag.message, "'m/s' is no unit") != NULL);
}

int main(void)
{
    RUN(a_list_has_one_unit_of_a_dimension);
    RUN(units_have_their_factors);
    RUN(compound_units_multiply);
    RUN(faults_are_located);
    RUN(ambiguous_letters_are_refused);
    RUN(slips_are_understood);
    RUN(every_unit_is_found_and_is_listed);
    return test_end();
}
