/* wrong.h: the blocks of tests/session/wrong.txt, wrong statements and what is said about them
 *
 * A block is a kind ("syntax" or "model": what refuses it), then lines that start with
 *   =  a statement to run first
 *   !  the wrong statement
 *   @  the column, and a part of the message
 *   ?  a part of the hint
 * Blocks stand between blank lines; "#" starts a comment. */
#ifndef COTREE_TESTS_WRONG_H
#define COTREE_TESTS_WRONG_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Wrong {
    int line; /* of the wrong statement in the file */
    char kind[16];
    char setup[4000]; /* lines, each ended by \n */
    char text[1000];
    int column;
    char message[400];
    char hint[400]; /* empty: any */
} Wrong;

/* what fits of a text */
static void wrong_keep(char *to, size_t size, const char *text)
{
    size_t length = strlen(text);

    length = length < size ? length : size - 1;
    memcpy(to, text, length);
    to[length] = '\0';
}

/* the next block; false at the end of the file */
static bool wrong_next(FILE *file, int *line, Wrong *wrong)
{
    char room[1200];

    *wrong = (Wrong){0};
    while (fgets(room, sizeof room, file) != NULL) {
        char *rest = room[0] != '\0' && room[1] == ' ' ? room + 2 : room;
        char *text;

        ++*line;
        room[strcspn(room, "\n")] = '\0';
        if (room[0] == '#')
            continue;
        if (room[0] == '\0') {
            if (wrong->text[0] != '\0')
                return true;
        } else if (room[0] == '=') {
            strcat(wrong->setup, rest);
            strcat(wrong->setup, "\n");
        } else if (room[0] == '!') {
            wrong->line = *line;
            strcpy(wrong->text, rest);
        } else if (room[0] == '@') {
            wrong->column = (int)strtol(rest, &text, 10);
            wrong_keep(wrong->message, sizeof wrong->message, text + (*text == ' '));
        } else if (room[0] == '?')
            wrong_keep(wrong->hint, sizeof wrong->hint, rest);
        else
            wrong_keep(wrong->kind, sizeof wrong->kind, room);
    }
    return wrong->text[0] != '\0';
}

static FILE *wrong_open(void)
{
    const char *source = getenv("TOP_SRCDIR");
    char path[1024];

    (void)snprintf(path, sizeof path, "%s/tests/session/wrong.txt", source != NULL ? source : ".");
    return fopen(path, "r");
}

#endif
