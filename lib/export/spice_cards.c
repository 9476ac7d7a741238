/* spice_cards.c: lines of a netlist to cards and their words */
#include "export/spice_cards.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

bool spice_is(const char *a, const char *b)
{
    return strcasecmp(a, b) == 0;
}

/* start of a comment at the end of a line: `;`, `//`, or ` $` */
static size_t before_comment(const char *line, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (line[i] == ';' || (line[i] == '/' && i + 1 < length && line[i + 1] == '/') ||
            (line[i] == '$' && (i == 0 || isspace((unsigned char)line[i - 1])) &&
             (i + 1 == length || isspace((unsigned char)line[i + 1]))))
            return i;
    return length;
}

static bool is_between(char c)
{
    return isspace((unsigned char)c) || c == ',' || c == '(' || c == ')' || c == '\0';
}

/* Words of a line join those of the card. An expression in braces or quotes is one. */
static void add_words(Import *import, Card *card, const char *line, size_t length)
{
    for (size_t i = 0; i < length;) {
        const size_t begin = i;
        const char closing = line[i] == '{' ? '}' : line[i] == '\'' || line[i] == '"' ? line[i] : 0;

        if (is_between(line[i])) {
            i++;
            continue;
        }
        if (line[i] == '=') {
            i++;
        } else if (closing != 0) {
            do
                i++;
            while (i < length && line[i] != closing);
            i += i < length;
        } else {
            while (i < length && !is_between(line[i]) && line[i] != '=' && line[i] != '{')
                i++;
        }
        LIST_PUSH(card->words, pool_text(import->pool, line + begin, i - begin));
    }
}

static bool begins(const char *line, size_t length, const char *word)
{
    return length >= strlen(word) && strncasecmp(line, word, strlen(word)) == 0;
}

/* The first line, no card; it often starts with a "*". */
static void write_title(Import *import, const char *line, size_t length)
{
    while (length > 0 && (*line == '*' || *line == ' ' || *line == '\t')) {
        line++;
        length--;
    }
    import_title(import, 1, pool_text(import->pool, line, length));
}

/* Lines to cards; the first is the title. Lines between .control and .endc are commands. */
void cards_read(Import *import, const char *text, size_t length, Cards *out)
{
    bool commands = false;
    int number = 0;

    for (size_t at = 0; at < length;) {
        const char *end = memchr(text + at, '\n', length - at);
        const size_t full = end != NULL ? (size_t)(end - (text + at)) : length - at;
        const char *line = text + at;
        size_t size = full;

        number++;
        at += full + 1;
        while (size > 0 && isspace((unsigned char)*line)) {
            line++;
            size--;
        }
        if (number == 1) {
            write_title(import, line, size);
            continue;
        }
        if (size == 0 || *line == '*' || *line == '#')
            continue;
        size = before_comment(line, size);
        if (begins(line, size, ".control") && !commands) {
            import_leave(import, number, false, ".control", "commands of a simulator");
            commands = true;
        } else if (begins(line, size, ".endc")) {
            commands = false;
        } else if (!commands && begins(line, size, ".end") &&
                   (size == 4 || isspace((unsigned char)line[4]))) {
            break;
        } else if (!commands && *line == '+' && out->count > 0) {
            add_words(import, &out->at[out->count - 1], line + 1, size - 1);
        } else if (!commands) {
            LIST_PUSH((*out), (Card){.line = number, .element = -1});
            add_words(import, &out->at[out->count - 1], line, size);
            if (out->at[out->count - 1].words.count == 0)
                out->count--;
        }
    }
}

const char *card_word(const Card *card, int i)
{
    return i < card->words.count ? card->words.at[i] : "";
}

bool card_is_key(const Card *card, int i)
{
    return i + 1 < card->words.count && card->words.at[i + 1][0] == '=';
}

/* value of the key from word `first` on; NULL: none */
const char *card_key(const Card *card, int first, const char *name)
{
    for (int i = first; i + 2 < card->words.count; i++)
        if (card_is_key(card, i) && spice_is(card->words.at[i], name))
            return card->words.at[i + 2];
    return NULL;
}
