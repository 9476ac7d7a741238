/* units.c: names of units and what they are in SI
 *
 * A unit is num/den * pi^pi_power of the SI unit of its dimension. Names follow SI; where
 * a letter would mean two things (t, h, d), the unit is spelled out. */
#include "expr/units.h"

#include "base/memory.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define PI 3.14159265358979323846

typedef enum Prefixes { NO_PREFIX, SI_PREFIX, CM_PREFIX } Prefixes; /* none; k, m ...; c, d too */

typedef struct UnitRow {
    const char *name;
    long long num;
    long long den;
    int pi_power;
    Prefixes prefixes;
    bool named; /* dimensions print with it */
    signed char power[6];
} UnitRow;

/* clang-format off */
static const UnitRow rows[] = {
    /*                num    den pi  prefixes   named    m kg  s  A  K rad */
    {"m",               1,     1, 0, CM_PREFIX, false, { 1, 0, 0, 0, 0, 0}},
    {"g",               1,  1000, 0, SI_PREFIX, false, { 0, 1, 0, 0, 0, 0}},
    {"s",               1,     1, 0, SI_PREFIX, false, { 0, 0, 1, 0, 0, 0}},
    {"A",               1,     1, 0, SI_PREFIX, false, { 0, 0, 0, 1, 0, 0}},
    {"K",               1,     1, 0, SI_PREFIX, false, { 0, 0, 0, 0, 1, 0}},
    {"rad",             1,     1, 0, SI_PREFIX, false, { 0, 0, 0, 0, 0, 1}},
    {"deg",             1,   180, 1, NO_PREFIX, false, { 0, 0, 0, 0, 0, 1}},
    {"rev",             2,     1, 1, NO_PREFIX, false, { 0, 0, 0, 0, 0, 1}},
    {"rpm",             1,    30, 1, NO_PREFIX, false, { 0, 0,-1, 0, 0, 1}},
    {"N",               1,     1, 0, SI_PREFIX, true,  { 1, 1,-2, 0, 0, 0}},
    {"Nm",              1,     1, 0, SI_PREFIX, false, { 2, 1,-2, 0, 0, 0}},
    {"J",               1,     1, 0, SI_PREFIX, false, { 2, 1,-2, 0, 0, 0}},
    {"W",               1,     1, 0, SI_PREFIX, true,  { 2, 1,-3, 0, 0, 0}},
    {"Wh",           3600,     1, 0, SI_PREFIX, false, { 2, 1,-2, 0, 0, 0}},
    {"Pa",              1,     1, 0, SI_PREFIX, true,  {-1, 1,-2, 0, 0, 0}},
    {"bar",        100000,     1, 0, SI_PREFIX, false, {-1, 1,-2, 0, 0, 0}},
    {"atm",        101325,     1, 0, NO_PREFIX, false, {-1, 1,-2, 0, 0, 0}},
    {"Hz",              1,     1, 0, SI_PREFIX, false, { 0, 0,-1, 0, 0, 0}},
    {"V",               1,     1, 0, SI_PREFIX, true,  { 2, 1,-3,-1, 0, 0}},
    {"ohm",             1,     1, 0, SI_PREFIX, true,  { 2, 1,-3,-2, 0, 0}},
    {"Ω",               1,     1, 0, SI_PREFIX, false, { 2, 1,-3,-2, 0, 0}},
    {"S",               1,     1, 0, SI_PREFIX, true,  {-2,-1, 3, 2, 0, 0}},
    {"C",               1,     1, 0, SI_PREFIX, true,  { 0, 0, 1, 1, 0, 0}},
    {"Ah",           3600,     1, 0, SI_PREFIX, false, { 0, 0, 1, 1, 0, 0}},
    {"F",               1,     1, 0, SI_PREFIX, true,  {-2,-1, 4, 2, 0, 0}},
    {"H",               1,     1, 0, SI_PREFIX, true,  { 2, 1,-2,-2, 0, 0}},
    {"Wb",              1,     1, 0, SI_PREFIX, false, { 2, 1,-2,-1, 0, 0}},
    {"T",               1,     1, 0, SI_PREFIX, true,  { 0, 1,-2,-1, 0, 0}},
    {"L",               1,  1000, 0, CM_PREFIX, false, { 3, 0, 0, 0, 0, 0}},
    {"l",               1,  1000, 0, CM_PREFIX, false, { 3, 0, 0, 0, 0, 0}},
    {"min",            60,     1, 0, NO_PREFIX, false, { 0, 0, 1, 0, 0, 0}},
    {"hour",         3600,     1, 0, NO_PREFIX, false, { 0, 0, 1, 0, 0, 0}},
    {"day",         86400,     1, 0, NO_PREFIX, false, { 0, 0, 1, 0, 0, 0}},
    {"tonne",        1000,     1, 0, NO_PREFIX, false, { 0, 1, 0, 0, 0, 0}},
    {"gn",         980665,100000, 0, NO_PREFIX, false, { 1, 0,-2, 0, 0, 0}},
};

static const struct {
    const char *name;
    long long num;
    long long den;
} prefixes[] = {
    {"f", 1, 1000000000000000}, {"p", 1, 1000000000000}, {"n", 1, 1000000000},
    {"u", 1, 1000000}, {"µ", 1, 1000000}, {"μ", 1, 1000000}, {"m", 1, 1000},
    {"c", 1, 100}, {"d", 1, 10},
    {"k", 1000, 1}, {"M", 1000000, 1}, {"G", 1000000000, 1}, {"T", 1000000000000, 1},
};

/* what people write, and what it is called here */
static const struct {
    const char *word;
    const char *unit;
} meant[] = {
    {"h", "hour"}, {"hr", "hour"}, {"hrs", "hour"}, {"hours", "hour"}, {"d", "day"}, {"days", "day"},
    {"t", "tonne"}, {"sec", "s"}, {"seconds", "s"}, {"msec", "ms"}, {"usec", "us"},
    {"minutes", "min"}, {"degrees", "deg"}, {"degree", "deg"}, {"radians", "rad"},
    {"meter", "m"}, {"meters", "m"}, {"metre", "m"}, {"metres", "m"}, {"micron", "um"},
    {"volt", "V"}, {"volts", "V"}, {"amp", "A"}, {"amps", "A"}, {"ampere", "A"},
    {"watt", "W"}, {"watts", "W"}, {"newton", "N"}, {"newtons", "N"}, {"joule", "J"},
    {"farad", "F"}, {"henry", "H"}, {"hertz", "Hz"}, {"kelvin", "K"}, {"pascal", "Pa"},
    {"liter", "L"}, {"litre", "L"}, {"gram", "g"}, {"grams", "g"}, {"kilogram", "kg"},
    {"Meg", "Mohm"}, {"MEG", "Mohm"}, {"meg", "Mohm"}, {"turn", "rev"}, {"RPM", "rpm"},
};

/* prefixed names that a slip may have been meant for */
static const char *const common[] = {
    "mm", "cm", "km", "um", "nm", "kg", "mg", "ms", "us", "ns", "mA", "uA", "kA", "mrad",
    "kN", "MN", "mN", "kJ", "MJ", "mJ", "kW", "MW", "mW", "kWh", "kPa", "MPa", "GPa", "mbar",
    "kHz", "MHz", "GHz", "mV", "uV", "kV", "kohm", "Mohm", "mohm", "mS", "mC", "uC", "nC",
    "mAh", "mF", "uF", "nF", "pF", "mH", "uH", "nH", "mT", "mWb", "mL", "ml",
};
/* clang-format on */

/* --- finding --- */

static const UnitRow *row_find(const char *name, size_t length)
{
    for (int i = 0; i < COUNT(rows); i++) {
        if (strlen(rows[i].name) == length && strncmp(rows[i].name, name, length) == 0)
            return &rows[i];
    }
    return NULL;
}

static void set_factor(Unit *unit)
{
    if (unit->den != 0)
        unit->factor = (double)unit->num / (double)unit->den * pow(PI, unit->pi_power);
}

static Unit unit_of(const UnitRow *row, long long num, long long den)
{
    Unit unit = {.num = row->num * num, .den = row->den * den, .pi_power = row->pi_power};

    /* at most one of the two has a common divisor with the other: powers of ten */
    while (unit.num % 10 == 0 && unit.den % 10 == 0) {
        unit.num /= 10;
        unit.den /= 10;
    }
    memcpy(unit.dimension.power, row->power, sizeof row->power);
    unit.is_cycles = strcmp(row->name, "Hz") == 0;
    set_factor(&unit);
    return unit;
}

static bool find_part(const char *name, size_t length, Unit *unit)
{
    const UnitRow *row = row_find(name, length);

    /* a name of its own wins over a prefix: min is no milli-inch */
    if (row != NULL) {
        *unit = unit_of(row, 1, 1);
        return true;
    }
    for (int i = 0; i < COUNT(prefixes); i++) {
        size_t skip = strlen(prefixes[i].name);
        bool hundredths = prefixes[i].den == 100 || prefixes[i].den == 10;

        if (skip >= length || strncmp(prefixes[i].name, name, skip) != 0)
            continue;
        row = row_find(name + skip, length - skip);
        if (row == NULL || row->prefixes == NO_PREFIX || (hundredths && row->prefixes != CM_PREFIX))
            continue;
        *unit = unit_of(row, prefixes[i].num, prefixes[i].den);
        return true;
    }
    return false;
}

bool unit_find(const char *name, Unit *unit)
{
    return find_part(name, strlen(name), unit);
}

/* --- arithmetic of dimensions --- */

bool dimension_same(Dimension a, Dimension b)
{
    return memcmp(a.power, b.power, 5) == 0;
}

bool dimension_has_angle(Dimension d)
{
    return d.power[5] != 0;
}

Dimension dimension_without_angle(Dimension d)
{
    static const int others[] = {0, 1, 3, 4};

    for (int i = 0; i < COUNT(others); i++)
        if (d.power[others[i]] != 0)
            d.power[5] = 0;
    return d;
}

static bool dimension_is_none(Dimension d)
{
    static const Dimension none;

    return memcmp(&d, &none, sizeof d) == 0;
}

bool dimension_times(Dimension a, Dimension b, int power, Dimension *out)
{
    for (int i = 0; i < 6; i++) {
        long long sum = a.power[i] + (long long)power * b.power[i];

        if (sum > SCHAR_MAX || sum < SCHAR_MIN)
            return false;
        a.power[i] = (signed char)sum;
    }
    *out = a;
    return true;
}

bool dimension_root(Dimension a, Dimension *out)
{
    for (int i = 0; i < 6; i++) {
        if (i < 5 && a.power[i] % 2 != 0)
            return false;
        a.power[i] /= 2;
    }
    *out = a;
    return true;
}

/* --- compound units --- */

static long long gcd(long long a, long long b)
{
    while (b != 0) {
        long long rest = a % b;

        a = b;
        b = rest;
    }
    return a;
}

/* Multiply by one more factor, once; false where a power no longer fits. */
static bool multiply(Unit *unit, const Unit *by, int sign)
{
    long long num = sign > 0 ? by->num : by->den;
    long long den = sign > 0 ? by->den : by->num;

    unit->factor = sign > 0 ? unit->factor * by->factor : unit->factor / by->factor;
    unit->pi_power += sign * by->pi_power;
    unit->is_cycles = by->is_cycles && dimension_is_none(unit->dimension) && sign > 0;
    if (!dimension_times(unit->dimension, by->dimension, sign, &unit->dimension))
        return false;
    if (unit->den != 0) {
        long long left = gcd(unit->num, den);
        long long right = gcd(num, unit->den);

        if (__builtin_mul_overflow(unit->num / left, num / right, &unit->num) ||
            __builtin_mul_overflow(unit->den / right, den / left, &unit->den))
            unit->den = 0;
    }
    set_factor(unit);
    return true;
}

static size_t skip_blanks(const char *text, size_t length, size_t at)
{
    while (at < length && (text[at] == ' ' || text[at] == '\t'))
        at++;
    return at;
}

/* [ "^" [ "-" ] digits ]; false, with *at at the fault, where no small integer follows */
static bool parse_power(const char *text, size_t length, size_t *at, int *power)
{
    int sign = 1;
    size_t digits;

    *power = 1;
    *at = skip_blanks(text, length, *at);
    if (*at >= length || text[*at] != '^')
        return true;
    *at = skip_blanks(text, length, *at + 1);
    if (*at < length && text[*at] == '-') {
        sign = -1;
        ++*at;
    }
    *power = 0;
    /* a third digit is too much, however many follow */
    for (digits = 0; digits < 3 && *at + digits < length; digits++) {
        if (!isdigit((unsigned char)text[*at + digits]))
            break;
        *power = *power * 10 + (text[*at + digits] - '0');
    }
    if (digits == 0 || digits > 2)
        return false;
    *at += digits;
    *power *= sign;
    return true;
}

/* ( UNIT | "1" ) [ power ] into `unit`, divided by it where `sign` is -1 */
static bool parse_factor(const char *text, size_t length, size_t *at, int sign, Unit *unit)
{
    size_t start = *at;
    size_t end = start;
    Unit part = {.factor = 1, .num = 1, .den = 1};
    int power;

    while (end < length && (isalpha((unsigned char)text[end]) || (text[end] & 0x80) != 0))
        end++;
    if (end == start && end < length && text[end] == '1')
        end++;
    else if (end == start || !find_part(text + start, end - start, &part))
        return false;
    *at = end;
    if (!parse_power(text, length, at, &power))
        return false;
    if (power < 0)
        sign = -sign;
    for (int i = abs(power); i > 0; i--) {
        if (!multiply(unit, &part, sign)) {
            *at = start;
            return false;
        }
    }
    return true;
}

bool unit_parse(const char *text, size_t length, Unit *unit, size_t *fault)
{
    Unit whole = {.factor = 1, .num = 1, .den = 1};
    size_t at = skip_blanks(text, length, 0);
    int sign = 1;

    for (;;) {
        if (!parse_factor(text, length, &at, sign, &whole))
            break;
        at = skip_blanks(text, length, at);
        if (at == length) {
            *unit = whole;
            return true;
        }
        if (text[at] != '*' && text[at] != '/')
            break;
        sign = text[at] == '*' ? 1 : -1;
        at = skip_blanks(text, length, at + 1);
    }
    *fault = at;
    return false;
}

const char *unit_spelled(const char *name)
{
    for (int i = 0; i < COUNT(meant); i++)
        if (strcmp(meant[i].word, name) == 0 ||
            (strlen(name) > 3 && strcasecmp(meant[i].word, name) == 0))
            return meant[i].unit;
    return NULL;
}

const char *unit_suggest(const char *name)
{
    Suggest suggest = suggest_for(name);

    if (unit_spelled(name) != NULL)
        return unit_spelled(name);
    for (int i = 0; i < COUNT(rows); i++)
        suggest_offer(&suggest, rows[i].name);
    for (int i = 0; i < COUNT(common); i++)
        suggest_offer(&suggest, common[i]);
    return suggest.best;
}

const char *unit_name(int i)
{
    return i >= 0 && i < COUNT(rows) ? rows[i].name : NULL;
}

const char *unit_common(int i)
{
    return i >= 0 && i < COUNT(common) ? common[i] : NULL;
}

const char *unit_prefix(int i)
{
    return i == 0 ? "" : i > 0 && i <= COUNT(prefixes) ? prefixes[i - 1].name : NULL;
}

/* --- printing dimensions --- */

/* How much there is to write: the sum of all powers. */
static int dimension_size(Dimension d)
{
    int size = 0;

    for (int i = 0; i < 6; i++)
        size += abs(d.power[i]);
    return size;
}

/* only to divide by, and no time: W/m^2 is meant where N/m/s is as short */
static bool divides_by_no_time(Dimension d)
{
    for (int i = 0; i < 6; i++)
        if (d.power[i] > 0)
            return false;
    return d.power[2] == 0;
}

/* The power of a named unit that shortens the text most, and the remaining dimension; NULL: none
 * does. A unit that would leave mass or current in the denominator is less clear than base units:
 * m/s^2 isn't printed as N/kg. */
static const char *dimension_named(Dimension whole, int *power, Dimension *rest)
{
    static const int powers[] = {1, 2, 3, 4, -1, -2, -3, -4};
    const char *name = NULL;
    int size = dimension_size(whole);

    *rest = whole;
    *power = 0;
    for (int i = 0; size > 1 && i < COUNT(rows) * COUNT(powers); i++) {
        const UnitRow *row = &rows[i / COUNT(powers)];
        const int p = powers[i % COUNT(powers)];
        Dimension left = whole;
        int written;

        if (!row->named)
            continue;
        for (int j = 0; j < 6; j++)
            left.power[j] = (signed char)(left.power[j] - p * row->power[j]);
        written = 1 + (p != 1) + (p < -1) + dimension_size(left);
        if (left.power[1] != 0 || left.power[3] != 0 || written > size ||
            (written == size &&
             (name == NULL || divides_by_no_time(*rest) || !divides_by_no_time(left))))
            continue;
        size = written;
        name = row->name;
        *power = p;
        *rest = left;
    }
    return name;
}

/* "^3", "" for 1 */
static void print_power(Text *text, int power)
{
    if (power > 1)
        text_addf(text, "^%d", power);
}

void dimension_print(Text *text, Dimension dimension)
{
    static const char *const bases[] = {"kg", "m", "s", "A", "K", "rad"};
    static const int places[] = {1, 0, 2, 3, 4, 5};
    Dimension rest;
    int named;
    const char *name = dimension_named(dimension, &named, &rest);
    bool first = true;

    if (named > 0) {
        text_add(text, name);
        print_power(text, named);
        first = false;
    }
    for (int i = 0; i < 6; i++) {
        int power = rest.power[places[i]];

        if (power <= 0)
            continue;
        text_addf(text, first ? "%s" : "*%s", bases[i]);
        print_power(text, power);
        first = false;
    }
    if (first)
        text_char(text, '1');
    if (named < 0) {
        text_addf(text, "/%s", name);
        print_power(text, -named);
    }
    for (int i = 0; i < 6; i++) {
        int power = -rest.power[places[i]];

        if (power <= 0)
            continue;
        text_addf(text, "/%s", bases[i]);
        print_power(text, power);
    }
}

/* --- units of the user's choice --- */

/* J, Wh and their multiples are of energies; other units of that dimension are of torques */
static bool is_of_energy(const char *name, size_t length)
{
    return (length > 0 && name[length - 1] == 'J') ||
           (length > 1 && name[length - 2] == 'W' && name[length - 1] == 'h');
}

/* the first of a list's units that has that dimension, of energies or of what else has it; the
 * length of its name, 0 where there is none */
static size_t find_listed(const char *units, Dimension wanted, bool of_energy, const char **name,
                          Unit *unit)
{
    for (const char *at = units + strspn(units, " "); *at != '\0'; at += strspn(at, " ")) {
        const size_t length = strcspn(at, " ");

        if (is_of_energy(at, length) == of_energy && find_part(at, length, unit) &&
            memcmp(&unit->dimension, &wanted, sizeof wanted) == 0) {
            *name = at;
            return length;
        }
        at += length;
    }
    return 0;
}

Status unit_list_check(const char *units, Diag *diag)
{
    for (const char *at = units + strspn(units, " "); *at != '\0'; at += strspn(at, " ")) {
        const int length = (int)strcspn(at, " ");
        const char *first;
        size_t first_length;
        Unit unit;

        if (!find_part(at, (size_t)length, &unit)) {
            diag_set(diag, E_UNIT, "'%.*s' is no unit; SI alone takes your choice back", length,
                     at);
            return E_UNIT;
        }
        first_length =
            find_listed(units, unit.dimension, is_of_energy(at, (size_t)length), &first, &unit);
        if (first != at) {
            diag_set(diag, E_UNIT, "%.*s and %.*s are units of the same: numbers are shown in one",
                     (int)first_length, first, length, at);
            return E_UNIT;
        }
        at += length;
    }
    return OK;
}

double energy_print_in(Text *text, const char *units)
{
    static const Dimension energy = {{2, 1, -2, 0, 0, 0}};
    const char *name = "J";
    Unit unit = {.factor = 1};
    const size_t length = find_listed(units, energy, true, &name, &unit);

    text_add_n(text, name, length > 0 ? length : 1);
    return length > 0 ? unit.factor : 1;
}

double dimension_print_in(Text *text, Dimension dimension, const char *units)
{
    static const struct {
        const char *name;
        Dimension dimension;
    } bases[] = {
        {"m", {{1, 0, 0, 0, 0, 0}}}, {"s", {{0, 0, 1, 0, 0, 0}}}, {"rad", {{0, 0, 0, 0, 0, 1}}}};
    const signed char *power = dimension.power;
    const char *name;
    Text in_si = {0};
    double size = 1;
    Unit unit;
    size_t length = find_listed(units, dimension, false, &name, &unit);

    if (length > 0) {
        text_add_n(text, name, length);
        return unit.factor;
    }
    dimension_print(&in_si, dimension);
    for (const char *at = in_si.at; *at != '\0';) {
        const size_t word = strspn(at, "abcdefghijklmnopqrstuvwxyz");

        length = 0;
        for (int i = 0; i < COUNT(bases) && (power[1] | power[3] | power[4]) == 0; i++)
            if (word == strlen(bases[i].name) && strncmp(at, bases[i].name, word) == 0) {
                length = find_listed(units, bases[i].dimension, false, &name, &unit);
                if (length > 0)
                    size *= pow(unit.factor, i == 0 ? power[0] : i == 1 ? power[2] : power[5]);
            }
        text_add_n(text, length > 0 ? name : at, length > 0 ? length : word > 0 ? word : 1);
        at += word > 0 ? word : 1;
    }
    text_free(&in_si);
    return size;
}
