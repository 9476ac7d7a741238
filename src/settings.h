/* settings.h: what the user can set about the shell itself: `set digits 10` */
#ifndef COTREE_SRC_SETTINGS_H
#define COTREE_SRC_SETTINGS_H

#include "cotree.h"

#include <stdio.h>

enum { SETTING_WORD = 24, SETTING_UNITS = 80 }; /* room for a word, and for names of units */

typedef struct Settings { /* a field a row of settings.def */
#define NUMBER(name, ...) int name;
#define WORD(name, ...)   char name[SETTING_WORD];
#define SWITCH(name, ...) bool name;
#define UNITS(name, ...)                                                                           \
    char name[SETTING_UNITS]; /* names with blanks between; "SI" has none of them */
#include "settings.def"
} Settings;

void settings_start(Settings *settings);
/* whether a `set` statement is about one of ours */
bool settings_own(const ct_statement *statement);
ct_status settings_apply(Settings *settings, const ct_statement *statement, ct_error *error);
/* remark what was shown in a unit of the user's choice and no longer is: the last choice is all
 * there is */
void settings_report_dropped(const Settings *old, const Settings *settings);
/* one by its name; CT_FAILED when the value is none for it */
ct_status settings_set(Settings *settings, const char *name, const char *value, ct_error *error);
/* the words of the i-th: its name, the values that are words, NULL; NULL: no more */
const char *const *settings_words(int i);
void settings_show(const Settings *settings, FILE *out);

#endif
