/* complete.c: completions at a position in an unfinished line
 *
 * The verb's row defines its operands; the words before the cursor determine which is next.
 * Completions are taken from the tables and from the model's names. */
#include "present/complete_impl.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* --- operands --- */

/* the row's words are offered at its first operand only */
static void offer_row_words(TypedLine *line, const Verb *verb)
{
    const bool is_first = line->before.count == 1;

    if (is_first || !source_is_once(verb->offers))
        (void)offer_source(line, verb->offers);
    for (int i = 0; is_first && !source_is_alone(verb->offers) && verb->words != NULL &&
                    verb->words[i] != NULL;
         i++)
        offer(line, verb->words[i]);
}

/* values follow a component's places only if it has such parameters */
static bool takes_value(const Verb *verb)
{
    bool takes = verb->component == NULL;

    for (int i = 0; !takes && i < verb->component->param_count; i++)
        takes = (verb->component->params[i].use & POSITIONAL) != 0;
    return takes;
}

static void offer_letter(TypedLine *line, const Verb *verb, char letter, int place)
{
    const bool has_source = verb->words != NULL || verb->offers != OFFERS_VALUES;
    const bool is_alone = source_is_alone(verb->offers); /* no other values than the source's */

    switch (letter) {
    case 'p':
    case 'P':
        if (verb->component != NULL)
            offer_place(line, verb->component, place);
        else if (!has_source)
            offer_names(line);
        break;
    case 'V':
        if (takes_value(verb))
            offer_values(line);
        break;
    case 'v':
    case 'e':
    case 'i':
    case 'I':
    case 'C':
        if (!is_alone)
            offer_values(line);
        break;
    case '=':
        if (verb->component != NULL && verb->component->places == PLACES_COORDINATE)
            offer_coordinates(line);
        else if (!has_source)
            offer_names(line);
        break;
    default:
        break;
    }
    if (strchr("wWotxlp=niI", letter) != NULL)
        offer_row_words(line, verb);
}

static void offer_keys(TypedLine *line, const Verb *verb)
{
    for (int i = 0; verb_key(verb, i) != NULL; i++)
        offer_key(line, verb_key(verb, i));
}

static bool has_word(const TypedLine *line, const char *word)
{
    for (int i = 0; i < line->before.count; i++)
        if (strcmp(line->before.at[i], word) == 0)
            return true;
    return false;
}

static bool has_pair(const TypedLine *line)
{
    for (int i = 0; i < line->before.count; i++)
        if (strchr(line->before.at[i], '=') != NULL)
            return true;
    return false;
}

/* after a possibly complete value, without comma or operator */
static bool ends_value(const TypedLine *line)
{
    size_t end = line->word;

    while (end > 0 && isspace((unsigned char)line->text[end - 1]))
        end--;
    return end > 0 &&
           (is_word_letter(line->text[end - 1]) || strchr(")]'\"", line->text[end - 1]) != NULL);
}

/* the words that may follow operands, each once */
static void offer_trailing(TypedLine *line, const Verb *verb, const char *pattern)
{
    for (; *pattern != '\0'; pattern++) {
        const char *word = pattern_word(*pattern);

        if (word == NULL || has_word(line, word) ||
            (*pattern == '@' && verb->offers == OFFERS_TOPICS && !topic_takes_instant(line)))
            continue;
        if (*pattern == 'C' && !has_word(line, "~"))
            word = "~"; /* a ~ b within c */
        offer(line, word);
    }
}

static void offer_operand(TypedLine *line, const Verb *verb, int first)
{
    const char *pattern = verb->pattern;
    const char *word = first < line->before.count ? line->before.at[first] : "";
    const bool has_options = verb->optioned == NULL || strcmp(word, verb->optioned) == 0;
    const bool has_operand = line->before.count > first && (pattern[0] != '=' || has_pair(line));
    int operand = first, place = 0, at = 0;

    while (operand < line->before.count && pattern[at] != '\0' &&
           strchr("nwWpPvVso", pattern[at]) != NULL && pattern[at + 1] != '*') {
        place += pattern[at] == 'p' || pattern[at] == 'P';
        at++;
        operand++;
    }
    /* expressions are separated by commas, items and words are not */
    if (pattern[at] != '\0' && pattern[at] != 'k' &&
        !(has_operand && strchr("eC", pattern[at]) != NULL && ends_value(line)))
        offer_letter(line, verb, pattern[at], place);
    if (!has_options || (strchr("eiC=", pattern[at]) != NULL && !has_operand))
        return;
    if (has_operand && ends_value(line))
        offer_trailing(line, verb, pattern);
    /* keys, if no operand is missing; V and P may be skipped */
    while (pattern[at] != '\0' && strchr("PVWIiextya@C*", pattern[at]) != NULL)
        at++;
    if (pattern[at] == 'k' || (pattern[at] == '=' && verb->component == NULL))
        offer_keys(line, verb);
}

/* --- the line --- */

/* offset of the statement at the cursor; false inside a string or comment */
static bool find_statement(const char *text, size_t cursor, size_t *start)
{
    bool quoted = false;

    *start = 0;
    for (size_t i = 0; i < cursor; i++) {
        if (text[i] == '"')
            quoted = !quoted;
        else if (!quoted && text[i] == '#')
            return false;
        else if (!quoted && (text[i] == ';' || text[i] == ':'))
            *start = i + 1;
    }
    while (*start < cursor && isspace((unsigned char)text[*start]))
        ++*start;
    return !quoted;
}

/* between blanks and commas outside brackets; what is in a bracket that is open yet is none */
static void split(TypedLine *line)
{
    size_t from = 0;
    int depth = 0;

    for (size_t i = 0; i <= line->word; i++) {
        const char c = i < line->word ? line->text[i] : ' ';

        depth += (c == '(' || c == '[') - (c == ')' || c == ']');
        if (depth > 0 || !(isspace((unsigned char)c) || c == ','))
            continue;
        if (i > from)
            LIST_PUSH(line->before, mem_text(line->text + from, i - from));
        from = i + 1;
    }
}

/* The key, with its primes, of the pair whose value the cursor is in, or directly follows
 * (*is_whole: the value may be complete). False: there is none. */
static bool find_key(const TypedLine *line, char *key, size_t size, bool *is_whole)
{
    size_t equals = 0, from;
    int depth = 0;

    for (size_t i = 1; i < line->word; i++) {
        const char c = line->text[i];

        depth += (c == '(' || c == '[') - (c == ')' || c == ']');
        if (c == ',' && depth <= 0)
            equals = 0;
        if (c == '=' && depth <= 0 && line->text[i + 1] != '=' &&
            strchr("=<>!", line->text[i - 1]) == NULL)
            equals = i;
    }
    if (equals == 0)
        return false;
    *is_whole = depth <= 0 && ends_value(line);
    while (equals > 0 && isspace((unsigned char)line->text[equals - 1]))
        equals--;
    from = equals;
    while (from > 0 && (is_word_letter(line->text[from - 1]) || line->text[from - 1] == '\''))
        from--;
    (void)snprintf(key, size, "%.*s", (int)(equals - from), line->text + from);
    return true;
}

/* the last word is the one of the pattern's letter */
static bool follows_word(const TypedLine *line, const Verb *verb, char letter)
{
    return strchr(verb->pattern, letter) != NULL &&
           strcmp(line->before.at[line->before.count - 1], pattern_word(letter)) == 0;
}

static void offer_after_verb(TypedLine *line)
{
    Verb verb;
    char key[128];
    bool is_whole = false, known = verb_find(line->before.at[0], &verb);
    const bool is_virtual = known && verb.room == ROOM_LANGUAGE;
    const bool has_key = find_key(line, key, sizeof key, &is_whole);

    if (is_virtual)
        known = line->before.count > 1 && verb_find(line->before.at[1], &verb);
    if (offer_units(line, known ? &verb : NULL, has_key ? key : NULL))
        return;
    if (line->before.at[0][0] == '?')
        offer_help_words(line);
    else if (strchr(line->prefix, '.') != NULL)
        offer_members(line, known ? &verb : NULL);
    else if (line->is_of_run)
        offer_variables(line);
    else if (is_virtual && line->before.count == 1)
        offer_joint_types(line);
    else if (known && has_key && !is_whole)
        offer_key_value(line, &verb, key);
    else if (known && follows_word(line, &verb, 'a'))
        offer_notations(line);
    else if (!known || follows_word(line, &verb, '@') || follows_word(line, &verb, 'C'))
        offer_values(line);
    else if (strchr(verb.pattern, 'T') != NULL)
        offer_verbs(line);
    else if (has_pair(line) && strchr(verb.pattern, 'k') != NULL)
        offer_keys(line, &verb);
    else
        offer_operand(line, &verb, is_virtual ? 2 : 1);
}

/* the length of `run1.` of a run that is there; 0: none */
static size_t run_length(const KnownName *known, const char *word)
{
    for (int i = 1; i <= known->runs; i++) {
        char name[24];
        const int length = snprintf(name, sizeof name, "run%d.", i);

        if (strncmp(word, name, (size_t)length) == 0)
            return (size_t)length;
    }
    return 0;
}

/* the length of a number that letters touch, 10k; 0: none */
static size_t number_length(const char *word)
{
    size_t length = strspn(word, "0123456789");

    length += length > 0 && word[length] == '.' ? 1 + strspn(word + length + 1, "0123456789") : 0;
    return isalpha((unsigned char)word[length]) ? length : 0;
}

/* start of the word to complete */
static void find_word(TypedLine *line)
{
    size_t skipped;

    line->word = strlen(line->text);
    while (line->word > 0 && is_word_letter(line->text[line->word - 1]))
        line->word--;
    skipped = run_length(line->known, line->text + line->word);
    line->is_of_run = skipped > 0;
    if (skipped == 0) {
        skipped = number_length(line->text + line->word);
        line->is_glued = skipped > 0;
    }
    line->word += skipped;
}

void complete_line(const KnownName *known, const char *text, size_t cursor, size_t *start,
                   Words *out)
{
    TypedLine line = {.known = known, .before = {0}, .out = out};
    char *copy;
    size_t statement;

    if (cursor > strlen(text))
        cursor = strlen(text);
    *start = cursor;
    if (!find_statement(text, cursor, &statement))
        return;
    copy = mem_text(text + statement, cursor - statement);
    line.text = copy;
    find_word(&line);
    *start = statement + line.word;
    if (strlen(copy + line.word) < sizeof line.prefix) {
        (void)snprintf(line.prefix, sizeof line.prefix, "%s", copy + line.word);
        split(&line);
        if (line.before.count == 0 && copy[0] == '?')
            offer_help_words(&line);
        else if (line.before.count == 0)
            offer_verbs(&line);
        else
            offer_after_verb(&line);
    }
    for (int i = 0; i < line.before.count; i++)
        mem_free(line.before.at[i]);
    LIST_FREE(line.before);
    mem_free(copy);
}
