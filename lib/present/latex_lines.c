/* latex_lines.c: formulas of LaTeX broken to the width of a page
 *
 * Widths are those of Computer Modern, roughly, a digit's as unit. A formula is cut before the
 * signs of its sums; where a cut lies between \left( and \right), the pair is closed and opened
 * again by invisible ones. A fraction whose numerator is wider than a line is written as a factor.
 */
#include "present/latex_lines.h"

#include "base/memory.h"

#include <ctype.h>
#include <string.h>

/* digits */
#define BINARY 2.45 /* a sign between terms with its spaces */
#define SCRIPT 0.7  /* size of superscripts and subscripts */

/* of room on a line that a cut leaves sooner than lie in a bracket, in one of a function */
enum { GROUP = 24, CALL = 100 };

/* --- widths --- */

static double width_to(const char **at, char end);

static bool is_command(const char *at, const char *name)
{
    const size_t length = strlen(name);

    return strncmp(at, name, length) == 0 && !isalpha((unsigned char)at[length]);
}

static double command_width(const char **at)
{
    /* letters are upright, and about as wide as others */
    static const char *const words[] = {"sin",  "cos",  "tan", "arcsin", "arccos", "arctan", "sinh",
                                        "cosh", "tanh", "exp", "ln",     "log",    "min",    "max"};
    /* commands without width of their own; their argument is counted */
    static const char *const silent[] = {"left",  "right", "mathrm", "text",
                                         "begin", "end",   "dot",    "ddot"};
    const char *name = *at + 1;
    size_t length = 0;

    while (isalpha((unsigned char)name[length]))
        length++;
    *at = name + (length > 0 ? length : 1);
    if (length == 0)
        return *name == ',' ? 0.35 : 0.7;
    for (int i = 0; i < COUNT(words); i++)
        if (is_command(name, words[i]))
            return 0.9 * (double)length + 0.35;
    for (int i = 0; i < COUNT(silent); i++)
        if (is_command(name, silent[i]))
            return 0;
    if (is_command(name, "frac")) {
        double upper, lower;

        *at += 1;
        upper = width_to(at, '}');
        *at += 1;
        lower = width_to(at, '}');
        return (upper > lower ? upper : lower) + 0.5;
    }
    return is_command(name, "quad") ? 2 : 1.1;
}

/* of the next token or group of TeX */
static double atom_width(const char **at)
{
    const char c = **at;

    if (c == '\\')
        return command_width(at);
    ++*at;
    switch (c) {
    case '{':
        return width_to(at, '}');
    case '_':
    case '^':
        return **at != '\0' ? SCRIPT * atom_width(at) : 0;
    case ' ':
    case '&':
    case '}':
        return 0;
    case '+':
    case '-':
    case '=':
    case '<':
    case '>':
        return **at == ' ' ? BINARY : 1.55;
    case '.':
    case '|':
    case '\'':
        return 0.55;
    default:
        return isalpha((unsigned char)c) ? 1.05 : 0.95;
    }
}

/* up to the bracket that closes the group, which is passed over; the end of the text is one too */
static double width_to(const char **at, char end)
{
    double width = 0;

    while (**at != '\0' && **at != end)
        width += atom_width(at);
    if (**at == end && end != '\0')
        ++*at;
    return width;
}

double latex_width(const char *formula)
{
    return width_to(&formula, '\0');
}

/* --- fractions --- */

/* the position after the group that starts at `at` */
static const char *group_end(const char *at)
{
    int depth = 0;

    for (; *at != '\0'; at++) {
        depth += (*at == '{') - (*at == '}');
        if (depth == 0)
            return at + 1;
    }
    return at;
}

/* \frac{a}{b} with a wide a as \frac{1}{b}\,\left(a\right) */
static void open_fractions(Text *out, const char *formula, double room)
{
    while (*formula != '\0') {
        const char *upper = formula + strlen("\\frac");
        const char *lower, *after;
        char *numerator;

        if (!is_command(formula, "\\frac")) {
            text_char(out, *formula++);
            continue;
        }
        lower = group_end(upper);
        after = group_end(lower);
        numerator = mem_text(upper + 1, (size_t)(lower - upper) - 2);
        if (latex_width(numerator) > room) {
            text_addf(out, "\\frac{1}%.*s\\,\\left(", (int)(after - lower), lower);
            open_fractions(out, numerator, room);
            text_add(out, "\\right)");
        } else {
            text_add_n(out, formula, (size_t)(after - formula));
        }
        mem_free(numerator);
        formula = after;
    }
}

/* --- lines --- */

typedef struct LatexPiece {
    size_t from;
    double width;
    int depth; /* of \left( before it */
    int price; /* of a cut before it, in digits */
} LatexPiece;

typedef LIST(LatexPiece) LatexLinesPieces;

/* a formula cut before the signs of its sums outside of groups */
static LatexLinesPieces cut(const char *formula)
{
    LatexLinesPieces pieces = {0};
    LIST(int) prices = {0}; /* of the brackets that are open */
    int price = 0, groups = 0;

    LIST_PUSH(pieces, (LatexPiece){0});
    for (size_t i = 0; formula[i] != '\0'; i++) {
        groups += (formula[i] == '{') - (formula[i] == '}');
        if (groups > 0)
            continue;
        if (is_command(formula + i, "\\left")) {
            /* \cos\left(, \sin^{2}\left( */
            const bool call =
                i > 0 && (isalpha((unsigned char)formula[i - 1]) || formula[i - 1] == '}');

            LIST_PUSH(prices, call ? CALL : GROUP);
            price += prices.at[prices.count - 1];
        } else if (is_command(formula + i, "\\right") && prices.count > 0) {
            price -= prices.at[--prices.count];
        }
        if (i > 0 && formula[i] == ' ' && strchr("+-", formula[i + 1]) != NULL &&
            formula[i + 1] != '\0' && formula[i + 2] == ' ')
            LIST_PUSH(pieces, (LatexPiece){.from = i + 1, .depth = prices.count, .price = price});
    }
    LIST_FREE(prices);
    for (int k = 0; k < pieces.count; k++) {
        const size_t end = k + 1 < pieces.count ? pieces.at[k + 1].from : strlen(formula);
        char *text = mem_text(formula + pieces.at[k].from, end - pieces.at[k].from);

        pieces.at[k].width = latex_width(text);
        mem_free(text);
    }
    return pieces;
}

/* the first piece of the next line, if a line starts with piece `from` */
static int line_end(const LatexLinesPieces *pieces, int from, double room)
{
    double width = pieces->at[from].width, best_score = -1e300;
    int best = from + 1;

    for (int k = from + 1; k < pieces->count && width <= room; k++) {
        const double score = width - pieces->at[k].price;

        if (score >= best_score) {
            best_score = score;
            best = k;
        }
        width += pieces->at[k].width;
    }
    return width <= room ? pieces->count : best;
}

static void add_times(Text *out, const char *text, int count)
{
    for (int i = 0; i < count; i++)
        text_add(out, text);
}

void latex_wrap(Text *out, const char *formula, double room)
{
    Text opened = {0};
    LatexLinesPieces pieces;

    open_fractions(&opened, formula, room);
    text_add(&opened, "");
    pieces = cut(opened.at);
    for (int from = 0, to; from < pieces.count; from = to) {
        const int depth = pieces.at[from].depth;
        const char *text = opened.at + pieces.at[from].from;
        size_t length;

        to = line_end(&pieces, from, room);
        length = to < pieces.count ? pieces.at[to].from - pieces.at[from].from - 1 : strlen(text);
        if (from > 0) {
            add_times(out, "\\right.", depth);
            text_add(out, " \\\\\n  &\\quad ");
            add_times(out, "\\left. {}", depth);
            text_add(out, depth > 0 ? " " : "");
        }
        text_add_n(out, text, length);
    }
    LIST_FREE(pieces);
    text_free(&opened);
}

/* --- text --- */

void latex_text(Text *out, const char *text)
{
    static const char *const to[] = {
        "\\textbackslash{}", "\\~{}", "\\^{}", "\\#", "\\$", "\\%", "\\&", "\\_", "\\{", "\\}"};

    text_replace(out, text, "\\~^#$%&_{}", to);
}
