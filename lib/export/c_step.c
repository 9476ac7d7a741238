/* c_step.c: one step of exported C, over sampling instants where there are any */
#include "export/c_step.h"

#include "export/shared_text.h"

#include <string.h>

static const char step[] =
    "\n$STATIC"
    "int model_$SMOOTH(const real *p, real t, real step, real *y, real *s, real *work)\n{\n"
    "    real *rate = work, *sum = rate + MODEL_Y, *at = sum + MODEL_Y, *rest = at + MODEL_Y;\n"
    "    int i, k;\n\n    for (i = 0; i < MODEL_Y; i++) {\n        at[i] = y[i];\n"
    "        sum[i] = 0;\n    }\n"
    "    for (k = 0; k < 4; k++) {\n        const real part = k == 2 ? step : step / 2;\n"
    "        const int status = model_rates(p, k == 0 ? t : k == 3 ? t + step : t + step / 2, at, "
    "s,"
    "\n                                       rest, rate);\n\n"
    "        if (status != MODEL_OK)\n            return status;\n"
    "        for (i = 0; i < MODEL_Y; i++) {\n"
    "            sum[i] += rate[i] * (k == 0 || k == 3 ? step / 6 : step / 3);\n"
    "            at[i] = y[i] + part * rate[i];\n        }\n    }\n"
    "    for (i = 0; i < MODEL_Y; i++)\n        y[i] += sum[i];\n"
    "    return model_project(p, t + step, y, rest);\n}\n";

/* step: that of what is smooth between two instants */
static const char sampled_step[] =
    "\nstatic const int model_sampled[] = {$SAMPLED}; /* in y */\n"
    "\n/* sampled states that are due at t: at whole multiples of their periods */\n"
    "static int model_sample($CONST"
    "real *p, real t, real *y, real *s, real *work)\n{\n"
    "    const real near = R(sizeof(real) > 4 ? 1e-9 : 1e-4);\n"
    "    real period[$SAMPLES], next[$SAMPLES];\n"
    "    int i, due = 0, status = MODEL_OK;\n\n    model_periods(p, t, y, s, period);\n"
    "    for (i = 0; i < $SAMPLES; i++)\n"
    "        due |= fabs(t / period[i] - floor(t / period[i] + 0.5)) <= near;\n"
    "    if (due)\n        status = model_solve(p, t, y, s, work);\n"
    "    if (!due || status != MODEL_OK)\n        return status;\n"
    "    model_samples(p, t, y, s, next);\n    for (i = 0; i < $SAMPLES; i++)\n"
    "        if (fabs(t / period[i] - floor(t / period[i] + 0.5)) <= near)\n"
    "            y[model_sampled[i]] = next[i];\n    return MODEL_OK;\n}\n"
    "\nint model_step($CONST"
    "real *p, real t, real step, real *y, real *s, real *work)\n{\n"
    "    const real near = R(sizeof(real) > 4 ? 1e-9 : 1e-4), end = t + step;\n"
    "    real period[$SAMPLES], until;\n    int i, status = MODEL_OK;\n\n"
    "    model_periods(p, t, y, s, period);\n"
    "    for (; status == MODEL_OK && t < end; t = until) {\n        until = end;\n"
    "        for (i = 0; i < $SAMPLES; i++) {\n"
    "            const real instant = period[i] * R(floor(t / period[i] + near) + 1);\n\n"
    "            if (instant < until - near * period[i])\n                until = instant;\n"
    "        }\n        status = model_sample(p, t, y, s, work);\n"
    "        if (status == MODEL_OK)\n"
    "            status = model_step_between(p, t, until - t, y, s, work);\n    }\n"
    "    return status;\n}\n";

/* a step through modes, with sampling instants if there are any */
void c_step_add_modes(const Code *code, const Language *language, Text *out)
{
    static const char name[] = "int model_step(";

    for (const char *const *line = shared_text_modes_step_c; *line != NULL; line++)
        if (code_is_sampled(code) && strncmp(*line, name, strlen(name)) == 0)
            text_addf(out, "static int model_step_between(%s", *line + strlen(name));
        else
            text_add(out, *line);
    if (code_is_sampled(code))
        code_fill(code, language, sampled_step, out);
}

void c_step_add(const Code *code, const Language *language, Text *out)
{
    code_fill(code, language, step, out);
    if (code_is_sampled(code) && !code_has_modes(code))
        code_fill(code, language, sampled_step, out);
}
