/* test_stored.c: a damaged file of a stored subsystem is refused, or is the same all the same */
#include "base/random.h"
#include "session_kit.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

static const char parts[] = "scene planar\nk = 2\nf(x) = k*x\n"
                            "subsystem rod frames=[A, B] terminals=[e] through=[o]\n"
                            "  L = 0.5 m # its length\n  body b mass=k inertia=f(0.1)\n"
                            "  arm a b [0, L/2]\n  arm B b [0, -L/2]\n  revolute h A a\n"
                            "  resistor R e o 10\n  resistor Q o 0 2\n  tree h\nend\n";
static const char equations[] =
    "scene planar\nsubsystem rod frames=[A, B] terminals=[e]\n  c = 3\n  unknown s, i\n"
    "  internal 2*s'' + c*(s - A.x) - i + B.fx\n  internal i' + i + s' - e.v\n"
    "  give B.x = s, B.y = 0, B.theta = 0\n  give e.i = i\nend\n";
static const char *const models[] = {parts, equations};

static char path[] = "/tmp/cotree-stored-XXXXXX";

/* store or load, which the kit leaves to a shell */
static ct_status carry(Kit *kit, const char *line, char **text)
{
    ct_cursor cursor = {.text = line, .line = 1};
    ct_statement *statement = NULL;
    ct_status status = ct_parse(&cursor, false, &statement, &kit->error);

    if (status == CT_OK)
        status = text != NULL ? ct_store(kit->session, statement, text, &kit->error)
                              : ct_load(kit->session, statement, &kit->error);
    ct_statement_free(statement);
    return status;
}

static char *stored(const char *model)
{
    Kit kit = kit_new();
    char *text = NULL;

    EXPECT(kit_do(&kit, model) == CT_OK);
    EXPECT(carry(&kit, "store rod \"x\"", &text) == CT_OK);
    kit_free(&kit);
    return text;
}

static void write_file(const char *text, size_t length)
{
    FILE *file = fopen(path, "wb");

    EXPECT(file != NULL && fwrite(text, 1, length, file) == length);
    if (file != NULL)
        EXPECT(fclose(file) == 0);
}

/* What loading leaves; NULL: it is refused, with a message at its place, and nothing has changed.
 * New. */
static char *loaded(const char *text, size_t length)
{
    Kit kit = kit_new();
    char line[64], *before, *after = NULL;
    ct_status status;

    write_file(text, length);
    snprintf(line, sizeof line, "load \"%s\"", path);
    EXPECT(kit_do(&kit, "scene planar") == CT_OK);
    before = ct_save(kit.session);
    status = carry(&kit, line, NULL);
    after = ct_save(kit.session);
    if (status != CT_OK) {
        EXPECT(kit.error.message[0] != '\0' && kit.error.line == 1 && kit.error.column > 0);
        EXPECT_TEXT(after, before);
        ct_free(after);
        after = NULL;
    }
    ct_free(before);
    kit_free(&kit);
    return after;
}

static void expect_refused_or_same(const char *text, size_t length, const char *whole)
{
    char *left = loaded(text, length);

    if (left != NULL)
        EXPECT_TEXT(left, whole);
    ct_free(left);
}

static void every_cut_and_every_flipped_byte_is_refused_or_loads_the_same(void)
{
    for (int m = 0; m < 2; m++) {
        char *text = stored(models[m]);
        const size_t length = strlen(text);
        char *whole = loaded(text, length);

        EXPECT(whole != NULL && strstr(whole, "subsystem rod") != NULL);
        for (size_t cut = 0; cut < length; cut++) {
            char *left = loaded(text, cut);

            EXPECT(left == NULL);
            ct_free(left);
        }
        for (size_t at = 0; at < length; at++) {
            const char was = text[at];

            text[at] ^= (char)(1U << at % 8);
            expect_refused_or_same(text, length, whole);
            text[at] = was;
        }
        ct_free(whole);
        ct_free(text);
    }
}

/* as who knows how the number in the first line is made could forge it (FNV-1a, of what follows) */
static void forge(char *text)
{
    char *body = strchr(text, '\n') + 1;
    uint64_t number = UINT64_C(14695981039346656037);
    char digits[20];

    for (const char *c = body; *c != '\0'; c++)
        number = (number ^ (unsigned char)*c) * UINT64_C(1099511628211);
    snprintf(digits, sizeof digits, "%016" PRIx64, number);
    memcpy(body - 17, digits, 16);
}

/* whatever is in it: a definition, or refused; nothing else of the model changes */
static void what_is_forged_defines_or_is_refused(void)
{
    uint64_t seed = 5;

    for (int m = 0; m < 2; m++) {
        char *text = stored(models[m]);
        const size_t length = strlen(text), head = (size_t)(strchr(text, '\n') + 1 - text);
        char *copy = malloc(length + 1), *left;

        for (int k = 0; k < 120; k++) {
            memcpy(copy, text, length + 1);
            for (int i = 0; i <= k % 3; i++) {
                const size_t at =
                    head + (size_t)((random_unit(&seed) + 1) / 2 * (double)(length - head - 1));

                copy[at] = k % 2 == 0 ? text[head + (at * 7 + (size_t)k) % (length - head)]
                                      : (char)(1 + (at * 31 + (size_t)k) % 255);
            }
            forge(copy);
            ct_free(loaded(copy, length));
        }
        strcpy(copy + head, "body b mass=1 inertia=1\n");
        forge(copy);
        EXPECT(loaded(copy, strlen(copy)) == NULL);
        /* a blank line in a definition is none */
        strcpy(copy + head, "subsystem s terminals=[a]\n\n  resistor R a 0 1\nend\n");
        forge(copy);
        left = loaded(copy, strlen(copy));
        EXPECT(left != NULL);
        ct_free(left);
        free(copy);
        ct_free(text);
    }
}

int main(void)
{
    const int file = mkstemp(path);

    if (file < 0)
        return 1;
    close(file);
    RUN(every_cut_and_every_flipped_byte_is_refused_or_loads_the_same);
    RUN(what_is_forged_defines_or_is_refused);
    remove(path);
    return test_end();
}
