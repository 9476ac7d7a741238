/* complete_offer.c: the words that go on as what is typed, each once */
#include "present/complete_impl.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

bool is_word_letter(char c)
{
    return isalnum((unsigned char)c) || c == '_' || c == '.';
}

void offer(TypedLine *line, const char *word)
{
    if (strncmp(word, line->prefix, strlen(line->prefix)) != 0)
        return;
    for (int i = 0; i < line->out->count; i++)
        if (strcmp(line->out->at[i], word) == 0)
            return;
    LIST_PUSH(*line->out, mem_text(word, strlen(word)));
}

void offer_key(TypedLine *line, const char *key)
{
    char word[128];

    (void)snprintf(word, sizeof word, "%s=", key);
    for (int i = 0; i < line->before.count; i++)
        if (strncmp(line->before.at[i], word, strlen(word)) == 0)
            return;
    offer(line, word);
}

/* words between bars */
void offer_alternatives(TypedLine *line, const char *words)
{
    while (*words != '\0') {
        const size_t length = strcspn(words, "|");
        char *word = mem_text(words, length);

        offer(line, word);
        mem_free(word);
        words += length + (words[length] == '|');
    }
}
