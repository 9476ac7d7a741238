/* session_draw.c: draw and animate: the graph, and the mechanism at instants of a run */
#include "session/session_shape.h"

#include "present/graph_picture.h"
#include "present/info.h"
#include "present/mechanism.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- options of the statement --- */

static const char *operand_word(const Statement *s, int i)
{
    const Syntax *value = i < s->operands.count ? s->operands.at[i].value : NULL;

    return value != NULL && value->kind == SYNTAX_VARIABLE && value->primes == 0 ? value->text : "";
}

static const Pair *find_key(const Statement *s, const char *name)
{
    for (int i = 0; i < s->pairs.count; i++)
        if (strcmp(s->pairs.at[i].name, name) == 0)
            return &s->pairs.at[i];
    return NULL;
}

/* which of some words is the key's value; `out` is unchanged without the key */
static Status read_choice(const Statement *s, const char *name, const char *const *words, int *out,
                          Diag *diag)
{
    const Pair *pair = find_key(s, name);
    Text list = {0};

    if (pair == NULL)
        return OK;
    for (int i = 0; words[i] != NULL; i++) {
        if (strcmp(words[i], pair->value->text) == 0) {
            text_free(&list);
            *out = i;
            return OK;
        }
        text_addf(&list, "%s%s", i > 0 ? ", " : "", words[i]);
    }
    (void)diag_at(diag, E_VALUE, pair->value->place, "%s= is one of %s", name, list.at);
    text_free(&list);
    return E_VALUE;
}

static Status read_options(const ct_session *session, const Statement *s, MechanismOptions *out,
                           Diag *diag)
{
    static const char *const looks[] = {"iso", "xy", "xz", "yz", NULL};
    static const char *const switches[] = {"off", "on", NULL};
    const Pair *view = find_key(s, "view");
    int look = LOOK_ISO, reactions = 0;

    if (view != NULL && model_is_planar(session->model))
        return diag_at(diag, E_VALUE, view->value->place,
                       "a planar scene is seen as it is, from its one side");
    TRY(read_choice(s, "view", looks, &look, diag));
    TRY(read_choice(s, "reactions", switches, &reactions, diag));
    *out = (MechanismOptions){.look = (Look)look, .reactions = reactions == 1};
    return OK;
}

/* --- pictures --- */

typedef struct Strip {
    Mechanism mechanism;
    ModeShape shape; /* of `mode`, that is drawn at phases of its period */
    int mode;        /* counted from 1; 0: instants of a run */
    double *values;  /* instants x items */
    double *times;
    int count;
    Picture *pictures; /* one an instant */
} Strip;

static void strip_free(Strip *strip)
{
    for (int i = 0; strip->pictures != NULL && i < strip->count; i++)
        picture_close(&strip->pictures[i]);
    mechanism_close(&strip->mechanism);
    shape_free(&strip->shape);
    MEM_FREE(strip->values, strip->times, strip->pictures);
}

/* which mode is drawn, if one is */
static Status read_mode(ct_session *session, const Statement *s, int *out, Diag *diag)
{
    const Pair *pair = find_key(s, "mode");
    double number = 0;

    if (pair != NULL)
        TRY(session_number(session, pair->value, &number, diag));
    if (pair != NULL && !(number >= 1 && number <= 1e6 && number == floor(number)))
        return diag_at(diag, E_VALUE, pair->value->place, "a mode is a whole number from 1 on");
    *out = (int)number;
    return OK;
}

/* All pictures of a strip are about one instant, in phases of a mode. */
static Status bend_strip(ct_session *session, const Statement *s, Run *run, Strip *strip,
                         Diag *diag)
{
    const int items = strip->mechanism.items.count;
    Status status = OK;

    if (strip->mode == 0)
        return OK;
    status = shape_find(session, run, strip->times[0], &strip->mechanism, strip->mode,
                        &strip->shape, diag);
    if (status == E_VALUE && diag->place.line == 0)
        diag->place = find_key(s, "mode")->value->place;
    for (int i = 0; status == OK && i < strip->count; i++)
        shape_move(&strip->shape, items, 2 * M_PI * i / strip->count,
                   strip->values + (size_t)i * (size_t)items);
    strip->mechanism.options.caption = strip->shape.caption;
    return status;
}

static Status fill_strip(ct_session *session, const Statement *s, Run *run, Strip *strip,
                         Diag *diag)
{
    const Mechanism *mechanism = &strip->mechanism;
    const int items = mechanism->items.count;
    Status status = OK;

    for (int i = 0; i < items; i++)
        mechanism->items.at[i] = session_add_outputs(session->model, mechanism->items.at[i]);
    strip->values = mem_array((size_t)strip->count * (size_t)items, sizeof *strip->values);
    strip->pictures = NEW_ARRAY(Picture, strip->count);
    CHECK(result_reader_prepare(run->reader, strip->times, strip->count, &session->watch, diag));
    for (int i = 0; i < strip->count; i++) {
        CHECK(monitor_poll(&session->watch));
        monitor_report(&session->watch, "drawing", (double)i / strip->count);
        CHECK(result_reader_values_at(run->reader, mechanism->items.at, items, strip->times[i],
                                      strip->values + (size_t)i * (size_t)items, diag));
    }
    CHECK(bend_strip(session, s, run, strip, diag));
    CHECK(mechanism_fit(&strip->mechanism, strip->values, strip->count, diag));
    for (int i = 0; i < strip->count; i++)
        mechanism_draw(mechanism, strip->values + (size_t)i * (size_t)items, strip->times[i],
                       &strip->pictures[i]);
done:
    return status;
}

static void write_picture(const ct_session *session, const Picture *picture, ct_paper *paper,
                          Text *out)
{
    const Animation alone = {.pictures = picture, .count = 1, .title = model_title(session->model)};

    paper->width = picture->width;
    paper->height = picture->height;
    if (strcmp(paper->format, "svg") == 0)
        picture_svg(&alone, out);
    else if (strcmp(paper->format, "gnuplot") == 0)
        picture_gnuplot(picture, out);
    else
        picture_characters(picture, paper->columns > 0 ? paper->columns : 79,
                           paper->rows > 0 ? paper->rows : 30, session->hooks.unicode, out);
}

static Status draw_mechanism(ct_session *session, const Statement *s, ct_paper *paper, Text *out,
                             Diag *diag)
{
    const View view = session_view(session);
    Strip strip = {.count = 1};
    MechanismOptions options = {0};
    Run *run = NULL;
    Status status;

    CHECK(read_options(session, s, &options, diag));
    CHECK(read_mode(session, s, &strip.mode, diag));
    CHECK(mechanism_open(&strip.mechanism, &view, options, diag));
    strip.times = NEW_ARRAY(double, 1);
    if (s->at != NULL)
        CHECK(session_instant(session, s->at, strip.times, diag));
    if (s->at != NULL && session->runs.count > 0)
        run = session->runs.at + session->runs.count - 1;
    else
        CHECK(session_start(session, &run, diag));
    if (s->at == NULL)
        strip.times[0] = result_times(run->result)[0];
    status = fill_strip(session, s, run, &strip, diag);
    if (status != OK && s->at != NULL && diag->place.line == 0)
        diag->place = s->at->place;
    CHECK(status);
    write_picture(session, &strip.pictures[0], paper, out);
done:
    strip_free(&strip);
    return status;
}

/* `collapsed` or `open` at the end: how instances of subsystems are drawn; default: open */
static int last_of_graph(const Statement *s, bool *collapsed)
{
    const int last = s->operands.count - 1;
    const char *word = last >= 0 ? operand_word(s, last) : "";

    *collapsed = strcmp(word, "collapsed") == 0;
    return *collapsed || strcmp(word, "open") == 0 ? last : last + 1;
}

/* which edge is lit, and how: `circuit h9`, `cutset h8` */
static Status read_lit(const Statement *s, int operands, Lit *lit, Diag *diag)
{
    const char *word = operands > 0 ? operand_word(s, 0) : "";

    *lit = strcmp(word, "circuit") == 0  ? LIT_CIRCUIT
           : strcmp(word, "cutset") == 0 ? LIT_CUTSET
                                         : LIT_NOTHING;
    if (operands > 0 && *lit == LIT_NOTHING)
        return diag_at(diag, E_SYNTAX, s->operands.at[0].place, "'draw' knows no '%s'", word);
    if (*lit != LIT_NOTHING && operands != 2)
        return diag_at(diag, E_SYNTAX, s->operands.at[0].place, "'draw %s' needs one edge", word);
    if (s->pairs.count > 0)
        return diag_at(diag, E_SYNTAX, s->pairs.at[0].value->place, "%s= is for 'draw mechanism'",
                       s->pairs.at[0].name);
    if (s->at != NULL)
        return diag_at(diag, E_SYNTAX, s->at->place, "the graph is the same at all times");
    return OK;
}

static Status draw_seen(ct_session *session, const View *view, Lit lit, const char *edge,
                        ct_paper *paper, Text *out, Diag *diag)
{
    Picture picture;

    if (strcmp(paper->format, "dot") == 0) {
        draw_dot(view, out);
        return OK;
    }
    if (lit == LIT_NOTHING && strcmp(paper->format, "text") == 0)
        return draw_text(view, out, diag);
    TRY(graph_picture(view, PICTURE_WIDEST, lit, edge, &picture, diag));
    write_picture(session, &picture, paper, out);
    picture_close(&picture);
    return OK;
}

static Status draw_graph(ct_session *session, const Statement *s, ct_paper *paper, Text *out,
                         Diag *diag)
{
    View view = session_view(session);
    TerminalGraph terminal = {.graph = NULL};
    bool collapsed;
    const int operands = last_of_graph(s, &collapsed);
    Lit lit;
    Status status;

    CHECK(read_lit(s, operands, &lit, diag));
    if (collapsed) {
        CHECK(terminal_graph_make(session->model, &terminal, diag));
        view.terminal = &terminal;
    }
    status = draw_seen(session, &view, lit, operand_word(s, 1), paper, out, diag);
    if (status != OK && lit != LIT_NOTHING && diag->place.line == 0)
        diag->place = s->operands.at[1].place;
done:
    terminal_graph_free(&terminal);
    return status;
}

ct_status ct_draw(ct_session *session, const ct_statement *statement, ct_paper *paper, char **text,
                  ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    Text out = {0};
    Diag diag = {0};
    Status status;

    session_begin(session);
    if (strcmp(operand_word(s, 0), "mechanism") == 0)
        status = draw_mechanism(session, s, paper, &out, &diag);
    else
        status = draw_graph(session, s, paper, &out, &diag);
    if (status == OK)
        *text = text_done(&out);
    text_free(&out);
    return session_report(status, &diag, error);
}

/* --- animate --- */

static const double PERIOD = 2;        /* s, the period of an animated mode */
static const double RATE = 25;         /* pictures a second */
static const double RATE_OF_TEXT = 8;  /* a terminal shows no more */
static const double MOST_FRAMES = 250; /* of a file */

/* the run that is named, or the last one */
static Status find_run(ct_session *session, const Statement *s, Run **out, Diag *diag)
{
    const char *word = operand_word(s, 0);
    char *end = NULL;
    const long number = strncmp(word, "run", 3) == 0 ? strtol(word + 3, &end, 10) : 0;

    if (s->operands.count > 1) {
        (void)diag_at(diag, E_SYNTAX, s->operands.at[1].place, "'animate' takes one run");
        return E_SYNTAX;
    }
    if (s->operands.count > 0 && (number < 1 || *end != '\0')) {
        (void)diag_at(diag, E_NAME, s->operands.at[0].place, "expected a run, as run2");
        return E_NAME;
    }
    if (session->runs.count == 0 || number > session->runs.count) {
        (void)diag_at(
            diag, E_MISSING, s->operands.count > 0 ? s->operands.at[0].place : s->verb_place,
            session->runs.count == 0 ? "there is no run to animate" : "there is no such run yet");
        diag_hint(diag, session->runs.count == 0 ? "simulate 1" : "'animate' alone takes the last");
        return E_MISSING;
    }
    *out = session->runs.at + (number > 0 ? number : session->runs.count) - 1;
    return OK;
}

typedef struct Span {
    double from, to, speed;
} Span;

static Status read_span(ct_session *session, const Statement *s, const Run *run, bool is_mode,
                        Span *out, Diag *diag)
{
    const double *times = result_times(run->result);
    const Pair *from = find_key(s, "from"), *to = find_key(s, "to"), *speed = find_key(s, "speed");

    *out = (Span){times[0], times[result_rows(run->result) - 1], 1};
    if (is_mode)
        out->to = out->from + PERIOD;
    if (from != NULL)
        TRY(session_instant(session, from->value, &out->from, diag));
    if (to != NULL)
        TRY(session_instant(session, to->value, &out->to, diag));
    if (speed != NULL)
        TRY(session_number(session, speed->value, &out->speed, diag));
    if (speed != NULL && !(out->speed > 0 && isfinite(out->speed)))
        return diag_at(diag, E_VALUE, speed->value->place,
                       "speed= is how often faster than it ran: a number above 0");
    if (is_mode && (from != NULL || to != NULL))
        return diag_at(diag, E_SYNTAX, (from != NULL ? from : to)->value->place,
                       "a mode moves about the start, through its own period");
    if (!(out->from < out->to))
        return diag_at(diag, E_VALUE, s->verb_place, "nothing moves from %.6g to %.6g s", out->from,
                       out->to);
    return OK;
}

static Status make_strip(ct_session *session, const Statement *s, double rate, double most,
                         Strip *strip, double *seconds, Diag *diag)
{
    const View view = session_view(session);
    MechanismOptions options = {0};
    Run *run = NULL;
    Span span;

    TRY(read_mode(session, s, &strip->mode, diag));
    if (strip->mode > 0 && s->operands.count == 0)
        TRY(session_start(session, &run, diag));
    else
        TRY(find_run(session, s, &run, diag));
    TRY(read_span(session, s, run, strip->mode > 0, &span, diag));
    TRY(read_options(session, s, &options, diag));
    TRY(mechanism_open(&strip->mechanism, &view, options, diag));
    *seconds = (span.to - span.from) / span.speed;
    strip->count = (int)fmax(2, fmin(most, ceil(*seconds * rate)));
    strip->times = NEW_ARRAY(double, strip->count);
    for (int i = 0; i < strip->count; i++)
        strip->times[i] = strip->mode > 0
                              ? span.from
                              : span.from + (span.to - span.from) * i / (strip->count - 1);
    TRY(fill_strip(session, s, run, strip, diag));
    for (int i = 0; strip->mode > 0 && i < strip->count; i++)
        strip->times[i] = strip->shape.period * i / strip->count;
    return OK;
}

ct_status ct_animate(ct_session *session, const ct_statement *statement, ct_paper *paper,
                     char ***frames, double *interval, ct_error *error)
{
    SESSION_WORK(session, error);

    const bool is_text = strcmp(paper->format, "text") == 0;
    const bool is_page = strcmp(paper->format, "html") == 0;
    const bool is_one = is_page || strcmp(paper->format, "svg") == 0;
    LIST(char *) out = {0};
    Strip strip = {0};
    double seconds = 0;
    Diag diag = {0};
    Status status;

    session_begin(session);
    CHECK(make_strip(session, statement_of(statement), is_text ? RATE_OF_TEXT : RATE,
                     is_text ? 1e4 : MOST_FRAMES, &strip, &seconds, &diag));
    *interval = seconds / strip.count;
    if (is_one) {
        const Animation film = {strip.pictures, strip.times, strip.count, seconds,
                                model_title(session->model)};
        Text text = {0};

        (is_page ? picture_html : picture_svg)(&film, &text);
        LIST_PUSH(out, text_done(&text));
    }
    for (int i = 0; !is_one && i < strip.count; i++) {
        Text text = {0};

        write_picture(session, &strip.pictures[i], paper, &text);
        LIST_PUSH(out, text_done(&text));
    }
    LIST_PUSH(out, NULL);
    *frames = out.at;
done:
    strip_free(&strip);
    return session_report(status, &diag, error);
}
