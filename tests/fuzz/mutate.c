/* mutate.c: mutations of good statements
 *
 * Bytes, words, lines and stretches are changed, doubled, dropped, swapped and taken from
 * other statements; words of the language come in by themselves. splitmix64 makes a run
 * repeatable from its seed. */
#include "mutate.h"

#include "base/memory.h"
#include "base/text.h"
#include "language/syntax.h"

#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

enum {
    LONGEST = 4000,  /* of an input, in bytes */
    SLOWEST = 10,    /* seconds that an input may take */
    MOST_CHANGES = 6 /* to one input */
};

/* One run of the driver; static, since the handlers of faults must reach the input. */
static struct {
    LIST(char *) lines;
    LIST(char *) words;
    uint64_t random;
    Text input;
} fuzz;

static uint64_t next_random(void)
{
    uint64_t z = (fuzz.random += 0x9E3779B97F4A7C15U);

    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

static size_t pick(size_t count)
{
    return count > 0 ? (size_t)(next_random() % count) : 0;
}

/* --- what the mutations start from --- */

static void add_line(const char *line, size_t length)
{
    LIST_PUSH(fuzz.lines, mem_text(line, length));
}

enum { WHOLE = 20 }; /* as often as some lines of it */

/* lines of a text, now and then several together */
static void add_text(const char *text)
{
    while (*text != '\0') {
        size_t length = strcspn(text, "\n");
        size_t more = length;

        for (int i = 0; i < 12 && text[more] != '\0'; i++)
            more += 1 + strcspn(text + more + 1, "\n");
        if (length > 0 && length < LONGEST)
            add_line(text, length);
        if (pick(8) == 0 && more < LONGEST)
            add_line(text, more);
        text += length + (text[length] == '\n' ? 1 : 0);
    }
}

static bool has_ending(const char *path, size_t length)
{
    static const char *const endings[] = {".ct", ".txt", ".cir", ".urdf"};

    for (int i = 0; i < COUNT(endings); i++)
        if (length > strlen(endings[i]) &&
            strcmp(path + length - strlen(endings[i]), endings[i]) == 0)
            return true;
    return false;
}

static int add_file(const char *path, const struct stat *info, int type, struct FTW *where)
{
    size_t length = strlen(path);
    Text text = {0};
    char room[4096];
    FILE *file;

    (void)info;
    (void)where;
    if (type != FTW_F || !has_ending(path, length))
        return 0;
    file = fopen(path, "rb");
    if (file == NULL)
        return 0;
    while (fgets(room, sizeof room, file) != NULL)
        text_add(&text, room);
    (void)fclose(file);
    if (text.at != NULL)
        add_text(text.at);
    /* other programs' files make sense as a whole */
    if (text.at != NULL && text.length < LONGEST && strcmp(path + length - 3, ".ct") != 0)
        for (int i = 0; i < WHOLE; i++)
            add_line(text.at, text.length);
    text_free(&text);
    return 0;
}

static void add_word(const char *word)
{
    LIST_PUSH(fuzz.words, mem_text(word, strlen(word)));
}

static void add_language(void)
{
    static const char *const pieces[] = {
        "=",      "==",  "'",       "''",     "(",      ")",           "[",    "]",      ",",
        ";",      "#",   "\"",      "\\",     "\n",     "\\\n",        "\r\n", "+",      "-",
        "*",      "/",   "^",       "<",      ">",      ">>",          ">=",   "!=",     "&&",
        "||",     "!",   "~",       ":",      "?",      ".",           "..",   " ",      "\t",
        "0",      "1",   "1e400",   "1e-400", ".5",     "2.",          "1/0",  "ground", "gnd",
        "t",      "pi",  "at",      "vs",     "within", "as",          "if",   "sin",    "mm",
        "[kN/m]", "deg", "virtual", "[0, 0]", "-1",     "\xC3\xA9",    "\xFF", "\x01",   "x",
        "m1",     "h1",  "1e9",     "-0",     "max",    "energy.total"};
    Verb verb;

    for (int i = 0; i < COUNT(pieces); i++)
        add_word(pieces[i]);
    for (int i = 0; verb_at(i, &verb); i++) {
        add_word(verb.name);
        for (int k = 0; verb_key(&verb, k) != NULL; k++)
            add_word(verb_key(&verb, k));
        for (int k = 0; verb.words != NULL && verb.words[k] != NULL; k++)
            add_word(verb.words[k]);
        if (verb.example != NULL) {
            add_text(verb.example);
            add_line(verb.example, strlen(verb.example));
        }
    }
}

/* --- mutations of fuzz.input --- */

static void replace(size_t start, size_t length, const char *by, size_t more)
{
    Text text = {0};

    text_add_n(&text, fuzz.input.at, start);
    text_add_n(&text, by, more);
    text_add(&text, fuzz.input.at + start + length);
    if (text.length < LONGEST) {
        text_free(&fuzz.input);
        fuzz.input = text;
    } else
        text_free(&text);
}

static void change_byte(size_t at)
{
    char c = (char)(1 + pick(255));

    replace(at, at < fuzz.input.length ? 1 : 0, &c, 1);
}

static void drop_stretch(size_t at)
{
    replace(at, pick(1 + fuzz.input.length - at) / (1 + pick(6)), "", 0);
}

static void double_stretch(size_t at)
{
    size_t length = pick(1 + fuzz.input.length - at);
    char *copy = mem_text(fuzz.input.at + at, length);

    for (size_t i = pick(1 + pick(40)); i + 1 > 0; i--)
        if (replace(at, 0, copy, length), i == 0)
            break;
    mem_free(copy);
}

static void insert_word(size_t at)
{
    const char *word = fuzz.words.at[pick((size_t)fuzz.words.count)];
    bool blanks = pick(2) == 0;

    replace(at, 0, blanks ? " " : "", blanks ? 1 : 0);
    replace(at, 0, word, strlen(word));
    replace(at, 0, blanks ? " " : "", blanks ? 1 : 0);
}

/* a word of the input becomes another word of the language */
static void change_word(size_t at)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    const char *word = fuzz.words.at[pick((size_t)fuzz.words.count)];
    size_t start = at;

    while (start > 0 && strchr(letters, fuzz.input.at[start - 1]) != NULL)
        start--;
    replace(start, strspn(fuzz.input.at + start, letters), word, strlen(word));
}

static void insert_line(size_t at)
{
    const char *line = fuzz.lines.at[pick((size_t)fuzz.lines.count)];
    size_t start = pick(2) == 0 ? 0 : pick(strlen(line));

    replace(at, 0, line + start, strlen(line + start));
    if (pick(2) == 0)
        replace(at, 0, pick(3) == 0 ? "; " : "\n", pick(3) == 0 ? 2 : 1);
}

static void mutate(void)
{
    static void (*const changes[])(size_t at) = {change_byte, drop_stretch, double_stretch,
                                                 insert_word, change_word,  insert_line,
                                                 insert_word, change_word};
    const char *line = fuzz.lines.at[pick((size_t)fuzz.lines.count)];

    text_free(&fuzz.input);
    text_add(&fuzz.input, line);
    for (size_t i = pick(MOST_CHANGES + 1); i > 0; i--)
        changes[pick(COUNT(changes))](pick(fuzz.input.length + 1));
}

/* --- faults --- */

/* also from handlers of signals, where only a few functions may be called */
static void say(const char *text)
{
    if (write(STDERR_FILENO, text, strlen(text)) < 0)
        return;
}

static void keep_input(void)
{
    int file = open("fuzz-fault.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);

    if (file < 0 || write(file, fuzz.input.at, fuzz.input.length) < 0)
        return;
    (void)close(file);
    say("the input is in fuzz-fault.txt\n");
}

static void stop_fault(int number)
{
    say(number == SIGALRM ? "an input took too long\n" : "fault\n");
    keep_input();
    _exit(1);
}

void mutate_claim(int holds, const char *claim)
{
    if (holds)
        return;
    say("not so: ");
    say(claim);
    say("\n");
    keep_input();
    abort();
}

static void watch_faults(void)
{
    (void)signal(SIGALRM, stop_fault);
#ifdef __SANITIZE_ADDRESS__
    __sanitizer_set_death_callback(keep_input);
#else
    (void)signal(SIGSEGV, stop_fault);
    (void)signal(SIGFPE, stop_fault);
    (void)signal(SIGABRT, stop_fault);
#endif
}

int main(int argc, char **argv)
{
    long seconds = 10;
    long count = 0;
    time_t start = time(NULL);

    fuzz.random = 1;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--seconds") == 0 && i + 1 < argc)
            seconds = strtol(argv[++i], NULL, 10);
        else if (strcmp(argv[i], "--seed") == 0 && i + 1 < argc)
            fuzz.random = strtoull(argv[++i], NULL, 10);
        else
            (void)nftw(argv[i], add_file, 8, FTW_PHYS);
    }
    add_language();
    watch_faults();
    for (; time(NULL) - start < seconds; count++) {
        mutate();
        (void)alarm(SLOWEST);
        mutate_target(fuzz.input.at);
    }
    (void)alarm(0);
    printf("%s: %ld inputs in %ld s, no fault\n", argv[0], count, seconds);

    for (int i = 0; i < fuzz.lines.count; i++)
        mem_free(fuzz.lines.at[i]);
    for (int i = 0; i < fuzz.words.count; i++)
        mem_free(fuzz.words.at[i]);
    LIST_FREE(fuzz.lines);
    LIST_FREE(fuzz.words);
    text_free(&fuzz.input);
    return 0;
}
