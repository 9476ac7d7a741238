/* test_syntax_verbs.c: every verb has its row, every row its texts, every example reads */
#include "test.h"

#include "base/memory.h"
#include "component/component.h"
#include "language/syntax.h"

static bool is_empty(const char *text)
{
    return text == NULL || text[0] == '\0';
}

static void rows_are_found_by_their_names(void)
{
    Verb verb;
    Verb found;

    for (int i = 0; verb_at(i, &verb); i++) {
        EXPECT(verb_find(verb.name, &found) && strcmp(found.name, verb.name) == 0);
        EXPECT(found.room == verb.room);
    }
    EXPECT(!verb_find("plto", &found));
}

static void no_name_has_two_rows(void)
{
    Verb a;
    Verb b;

    for (int i = 0; verb_at(i, &a); i++)
        for (int k = 0; k < i && verb_at(k, &b); k++)
            if (strcmp(a.name, b.name) == 0) {
                printf("%s\n", a.name);
                EXPECT(false);
            }
}

static void every_component_has_a_verb(void)
{
    const Component *row;
    Verb verb;

    for (int i = 0; (row = component_at(i)) != NULL; i++)
        EXPECT(verb_find(row->name, &verb) && verb.component == row);
}

static void every_row_has_its_texts(void)
{
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++) {
        bool whole = !is_empty(verb.brief) && verb.brief[strlen(verb.brief) - 1] != '.' &&
                     !is_empty(verb.help) && !is_empty(verb.example) && !is_empty(verb.see);
        Text usage = {0};

        verb_usage(&usage, &verb);
        EXPECT(whole && strncmp(usage.at, verb.name, strlen(verb.name)) == 0);
        EXPECT(strchr(usage.at, '\n') == NULL);
        if (!whole)
            printf("%s\n", verb.name);
        text_free(&usage);
    }
}

static void what_to_see_is_there(void)
{
    Verb verb;
    Verb other;

    for (int i = 0; verb_at(i, &verb); i++) {
        const char *see = verb.see != NULL ? verb.see : "";

        while (*see != '\0') {
            size_t length = strcspn(see, " ");
            char *word = mem_text(see, length);

            EXPECT(verb_find(word, &other));
            if (!verb_find(word, &other))
                printf("%s: %s\n", verb.name, word);
            mem_free(word);
            see += length + (see[length] == ' ' ? 1 : 0);
        }
    }
}

static void every_example_reads(void)
{
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++) {
        const char *text = verb.example != NULL ? verb.example : "";
        bool itself = false;
        size_t next = 0;

        while (next < strlen(text)) {
            Statement *s = NULL;
            Diag diag;

            if (statement_parse(text, 1, (SyntaxOptions){false}, &next, &s, &diag) != OK) {
                printf("%s:%d:%d: %s\n", verb.name, diag.place.line, diag.place.column,
                       diag.message);
                test_faults++;
                statement_free(s);
                break;
            }
            itself =
                itself || (s->verb != NULL && strcmp(s->verb, verb.name) == 0) || s->is_virtual;
            statement_free(s);
        }
        EXPECT(itself);
        if (!itself)
            printf("%s is not in its example\n", verb.name);
    }
}

static void every_letter_of_a_shape_is_known(void)
{
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++)
        EXPECT(strspn(verb.pattern, "npPwWvVeiItsoxlCTy@ak=>!:*") == strlen(verb.pattern));
}

static void keys_of_a_component_are_its_params(void)
{
    static const char *const wanted[] = {"axis", "coord"};
    Verb verb;

    EXPECT(verb_find("revolute", &verb));
    for (int i = 0; i < COUNT(wanted); i++)
        EXPECT_TEXT(verb_key(&verb, i), wanted[i]);
    EXPECT(verb_key(&verb, COUNT(wanted)) == NULL);
}

int main(void)
{
    RUN(rows_are_found_by_their_names);
    RUN(no_name_has_two_rows);
    RUN(every_component_has_a_verb);
    RUN(every_row_has_its_texts);
    RUN(what_to_see_is_there);
    RUN(every_example_reads);
    RUN(every_letter_of_a_shape_is_known);
    RUN(keys_of_a_component_are_its_params);
    return test_end();
}
