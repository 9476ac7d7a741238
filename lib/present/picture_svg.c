/* picture_svg.c: pictures as SVG, moved by SMIL, and as a page of HTML that plays them */
#include "present/picture.h"

#include <string.h>

static const char FONT[] = "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\"";

/* a tenth of a px is finer than any screen */
static void write_coordinate(Text *out, double value)
{
    text_addf(out, "%.1f", value);
}

static void write_ink(Text *out, const Ink *ink)
{
    static const char *const dashes[] = {
        [DASH_LONG] = "7 4", [DASH_DOTS] = "2 3", [DASH_CENTRE] = "10 3 2 3"};

    text_addf(out, " fill=\"%s\"", ink->fill != NULL ? ink->fill : "none");
    if (ink->stroke != NULL)
        text_addf(out,
                  " stroke=\"%s\" stroke-width=\"%.3g\" stroke-linejoin=\"round\" "
                  "stroke-linecap=\"round\"",
                  ink->stroke, ink->width);
    if (ink->dash != DASH_NONE)
        text_addf(out, " stroke-dasharray=\"%s\"", dashes[ink->dash]);
    text_add(out, "/>\n");
}

static void write_points(Text *out, const Picture *picture, const Shape *shape)
{
    for (int i = 0; i < shape->count; i++) {
        if (i > 0)
            text_char(out, ' ');
        write_coordinate(out, picture->points.at[shape->first + i].x);
        text_char(out, ',');
        write_coordinate(out, picture->points.at[shape->first + i].y);
    }
}

static void write_shape(Text *out, const Picture *picture, const Shape *shape)
{
    static const char *const anchors[] = {"start", "middle", "end"};
    const Point at = picture->points.at[shape->first];

    switch (shape->kind) {
    case SHAPE_LINE:
    case SHAPE_AREA:
        text_addf(out, "<%s points=\"", shape->kind == SHAPE_LINE ? "polyline" : "polygon");
        write_points(out, picture, shape);
        text_char(out, '"');
        write_ink(out, &shape->ink);
        break;
    case SHAPE_CIRCLE:
        text_addf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"", at.x, at.y, shape->size);
        write_ink(out, &shape->ink);
        break;
    case SHAPE_TEXT:
        text_addf(out,
                  "<text x=\"%.1f\" y=\"%.1f\" font-size=\"%.3g\" text-anchor=\"%s\" fill=\"%s\" "
                  "paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"3\">",
                  at.x, at.y, shape->size, anchors[shape->anchor], shape->ink.stroke);
        text_xml(out, shape->text);
        text_add(out, "</text>\n");
        break;
    }
}

/* Consecutive shapes of one part form a group, which shows the part's name as a tooltip. */
static void write_shapes(Text *out, const Picture *picture)
{
    const char *open = NULL;

    for (int i = 0; i < picture->shapes.count; i++) {
        const Shape *shape = &picture->shapes.at[i];

        if (open == NULL || strcmp(open, shape->what) != 0) {
            if (open != NULL && *open != '\0')
                text_add(out, "</g>\n");
            open = shape->what;
            if (*open != '\0') {
                text_addf(out, "<g class=\"%.*s\"><title>", (int)strcspn(open, " "), open);
                text_xml(out, open);
                text_add(out, "</title>\n");
            }
        }
        write_shape(out, picture, shape);
    }
    if (open != NULL && *open != '\0')
        text_add(out, "</g>\n");
}

static void open_svg(Text *out, const Animation *film, bool alone)
{
    const Picture *first = &film->pictures[0];

    text_addf(out, "<svg%s viewBox=\"0 0 %g %g\"",
              alone ? " xmlns=\"http://www.w3.org/2000/svg\"" : "", first->width, first->height);
    if (alone)
        text_addf(out, " width=\"%g\" height=\"%g\"", first->width, first->height);
    text_addf(out, " %s>\n", FONT);
    if (film->title != NULL && *film->title != '\0') {
        text_add(out, "<title>");
        text_xml(out, film->title);
        text_add(out, "</title>\n");
    }
    text_add(out, "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n");
}

/* each frame is shown for its part of the time, over and over */
static void write_frame(Text *out, const Animation *film, int i)
{
    const double from = (double)i / film->count, to = (double)(i + 1) / film->count;

    text_addf(out, "<g class=\"frame\"%s>\n", i > 0 ? " visibility=\"hidden\"" : "");
    text_addf(out,
              "<animate attributeName=\"visibility\" calcMode=\"discrete\" "
              "repeatCount=\"indefinite\" dur=\"%.4gs\" ",
              film->seconds);
    if (i == 0)
        text_addf(out, "keyTimes=\"0;%.6g\" values=\"visible;hidden\"/>\n", to);
    else if (i == film->count - 1)
        text_addf(out, "keyTimes=\"0;%.6g\" values=\"hidden;visible\"/>\n", from);
    else
        text_addf(out, "keyTimes=\"0;%.6g;%.6g\" values=\"hidden;visible;hidden\"/>\n", from, to);
    write_shapes(out, &film->pictures[i]);
    text_add(out, "</g>\n");
}

void picture_svg(const Animation *film, Text *out)
{
    open_svg(out, film, true);
    if (film->count == 1)
        write_shapes(out, &film->pictures[0]);
    for (int i = 0; film->count > 1 && i < film->count; i++)
        write_frame(out, film, i);
    text_add(out, "</svg>\n");
}

static const char STYLE[] =
    "<style>body{margin:0;font-family:Helvetica,Arial,sans-serif;color:#222}"
    "main{max-width:60rem;margin:auto;padding:1rem}svg{width:100%;height:auto;"
    "border:1px solid #ddd}.frame{display:none}.frame.on{display:inline}"
    "nav{display:flex;gap:.8rem;align-items:center}"
    "nav input{flex:1}</style>\n";

/* frames follow the elapsed time, so a slow machine skips frames */
static const char SCRIPT[] =
    "const frames = document.querySelectorAll('.frame'), slider = document.getElementById('at'),\n"
    "      button = document.getElementById('play'), shown = document.getElementById('time');\n"
    "let on = 0, playing = true, since = null;\n"
    "function show(i) {\n"
    "  frames[on].classList.remove('on'); on = i; frames[on].classList.add('on');\n"
    "  slider.value = i; shown.textContent = 't = ' + times[i].toPrecision(4) + ' s';\n"
    "}\n"
    "function step(now) {\n"
    "  if (since === null) since = now - on / frames.length * seconds * 1000;\n"
    "  show(Math.floor((now - since) / 1000 / seconds * frames.length) % frames.length);\n"
    "  if (playing) requestAnimationFrame(step);\n"
    "}\n"
    "function play(wanted) {\n"
    "  playing = wanted; since = null; button.textContent = wanted ? 'Pause' : 'Play';\n"
    "  if (wanted) requestAnimationFrame(step);\n"
    "}\n"
    "button.onclick = () => play(!playing);\n"
    "slider.oninput = () => { play(false); show(+slider.value); };\n"
    "show(0); play(true);\n";

void picture_html(const Animation *film, Text *out)
{
    const char *title = film->title != NULL && *film->title != '\0' ? film->title : "mechanism";

    text_add(out, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>");
    text_xml(out, title);
    text_addf(out, "</title>\n%s</head><body><main>\n", STYLE);
    open_svg(out, film, false);
    for (int i = 0; i < film->count; i++) {
        text_add(out, "<g class=\"frame\">\n");
        write_shapes(out, &film->pictures[i]);
        text_add(out, "</g>\n");
    }
    text_addf(out,
              "</svg>\n<nav><button id=\"play\">Pause</button>\n"
              "<input id=\"at\" type=\"range\" min=\"0\" max=\"%d\" value=\"0\" "
              "aria-label=\"time\">\n<output id=\"time\"></output></nav>\n</main>\n<script>\n"
              "const seconds = %.6g, times = [",
              film->count - 1, film->seconds);
    for (int i = 0; i < film->count; i++)
        text_addf(out, "%s%.6g", i > 0 ? "," : "", film->times != NULL ? film->times[i] : 0);
    text_addf(out, "];\n%s</script></body></html>\n", SCRIPT);
}
