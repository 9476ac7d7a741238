/* test_keys.c: keys that a verb has are read, others refused, and what is offered is there */
#include "session_kit.h"

#include "language/syntax.h"

/* the statement of the verb in its example, with `key` as something that isn't there */
typedef struct Spoiled {
    Text before; /* the lines in front */
    Text line;
    int column; /* of the wrong name */
} Spoiled;

#define NOTHING "nonesuch"

/* of a key that takes any new name: one that can't be */
static const char *wrong_value(const char *key)
{
    static const char *const naming[] = {"coord", "frames", "terminals", "through"};

    for (size_t i = 0; i < sizeof naming / sizeof naming[0]; i++)
        if (strcmp(key, naming[i]) == 0)
            return "2";
    return NOTHING;
}

static void spoil(Spoiled *out, const Statement *s, const char *line, size_t length,
                  const char *key)
{
    for (int i = 0; i < s->pairs.count; i++) {
        const Pair *pair = &s->pairs.at[i];

        if (strcmp(pair->name, key) != 0)
            continue;
        const size_t at = (size_t)pair->value->place.column - 1;

        text_add_n(&out->line, line, at);
        out->column = (int)out->line.length + 1;
        text_add(&out->line, wrong_value(key));
        text_add_n(&out->line, line + at + pair->value->place.width,
                   length - at - (size_t)pair->value->place.width);
        return;
    }
    /* before the colon of a statement that another follows */
    size_t end = s->rest != NULL ? (size_t)s->rest->place.column - 1 : length;

    while (s->rest != NULL && line[end - 1] != ':')
        end--;
    end -= s->rest != NULL;
    text_add_n(&out->line, line, end);
    text_addf(&out->line, " %s=", key);
    out->column = (int)out->line.length + 1;
    text_add(&out->line, wrong_value(key));
    text_char(&out->line, ' ');
    text_add_n(&out->line, line + end, length - end);
}

static bool find(const Verb *verb, const char *key, Spoiled *out)
{
    const char *line = verb->example;

    while (line != NULL && *line != '\0') {
        const size_t length = strcspn(line, "\n");
        Statement *s = NULL;
        Diag diag = {0};
        size_t next = 0;
        bool found = false;
        char *alone = mem_text(line, length);

        if (statement_parse(alone, 1, (SyntaxOptions){false}, &next, &s, &diag) == OK &&
            next == length) {
            found = s->verb != NULL && strcmp(s->verb, verb->name) == 0 && s->redirect == NULL;
            if (found)
                spoil(out, s, line, length, key);
        }
        statement_free(s);
        mem_free(alone);
        if (found)
            return true;
        text_add_n(&out->before, line, length);
        text_add(&out->before, "\n");
        line += length + (line[length] == '\n');
    }
    return false;
}

static void try_key(const Verb *verb, const char *key)
{
    Kit kit = kit_new();
    Spoiled spoiled = {0};

    if (!find(verb, key, &spoiled)) {
        test_faults++;
        printf("%s: no statement of it in its example\n", verb->name);
    } else {
        if (spoiled.before.at != NULL)
            EXPECT_DONE(&kit, spoiled.before.at);
        if (kit_do(&kit, spoiled.line.at) != CT_FAILED) {
            test_faults++;
            printf("%s: passes\n", spoiled.line.at);
        } else if (kit.error.column != spoiled.column &&
                   strstr(kit.error.message, "given twice") == NULL &&
                   strstr(kit.error.message, "takes no keys") == NULL) { /* of another topic */
            test_faults++;
            printf("%s: column %d, wanted %d: %s\n", spoiled.line.at, kit.error.column,
                   spoiled.column, kit.error.message);
        }
    }
    text_free(&spoiled.before);
    text_free(&spoiled.line);
    kit_free(&kit);
}

static void every_key_is_read(void)
{
    Verb verb;

    /* what the shell carries out (save) is tried by its sessions */
    for (int i = 0; verb_at(i, &verb); i++)
        for (int k = 0; verb.group != GROUP_SESSION && verb_key(&verb, k) != NULL; k++)
            try_key(&verb, verb_key(&verb, k));
}

/* no verb but those that take any pairs has a key that isn't in its row */
static void no_other_key_passes(void)
{
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++) {
        Kit kit = kit_new();
        Spoiled spoiled = {0};

        if (strchr(verb.pattern, 'k') != NULL && find(&verb, "nokey", &spoiled)) {
            EXPECT(kit_do(&kit, spoiled.before.at != NULL ? spoiled.before.at : "") == CT_OK);
            EXPECT_FAILS(&kit, spoiled.line.at, "has no key 'nokey'");
        }
        text_free(&spoiled.before);
        text_free(&spoiled.line);
        kit_free(&kit);
    }
}

static void keys_without_anything_to_act_on_are_refused(void)
{
    static const char *const keys[] = {"rtol=1e-6", "atol=1e-6", "method=radau",
                                       "step=0.01", "maxstep=1", "check=on"};
    static const char *const verbs[] = {"kinematics", "inverse"};

    for (size_t v = 0; v < sizeof verbs / sizeof verbs[0]; v++)
        for (size_t k = 0; k < sizeof keys / sizeof keys[0]; k++) {
            Kit kit = kit_new();
            char line[80];

            EXPECT_DONE(&kit, PENDULUM "init none\ndriver D1 h = t\n");
            (void)snprintf(line, sizeof line, "%s 1 every=0.1 %s", verbs[v], keys[k]);
            EXPECT_FAILS(&kit, line, "nothing is integrated");
            EXPECT(kit.error.column == (int)strlen(verbs[v]) + 14);
            kit_free(&kit);
        }
}

int main(void)
{
    RUN(every_key_is_read);
    RUN(no_other_key_passes);
    RUN(keys_without_anything_to_act_on_are_refused);
    return test_end();
}
