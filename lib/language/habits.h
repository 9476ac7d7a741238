/* habits.h: what people used to other programs and languages type, and how it is written here */
#ifndef COTREE_LANGUAGE_HABITS_H
#define COTREE_LANGUAGE_HABITS_H

typedef enum HabitKind {
    HABIT_VERB,     /* run, exit ... */
    HABIT_FUNCTION, /* ln, pow ... */
    HABIT_NAME,     /* e, PI ... */
    HABIT_UNIT,     /* inch, percent ... */
    HABIT_OPERATOR  /* and, mod ..., between values */
} HabitKind;

/* a sentence with the way out; NULL: nothing known */
const char *habit_hint(HabitKind kind, const char *word);

#endif
