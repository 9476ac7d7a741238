/* session_spectrum.c: spectrum(h8) over the last run, of `plot`, `table` and `export csv`
 *
 * The argument is sampled uniformly from the dense output, whatever the output points of the run.
 * Its mean is the value at 0 Hz. The rest is multiplied by the Hann window, scaled to mean 1, so
 * that a tone of whole periods shows its amplitude. Tones above half the sampling rate are aliased.
 * Two sample counts without a common factor alias them to different frequencies, so the counts are
 * raised until two spectra agree. An amplitude that may be due to rounding alone is 0. */
#include "session/session_impl.h"

#include <gsl/gsl_fft_real.h>
#include <math.h>

/* of samples: powers of one prime, which the transform is fast at, of another than the next's */
static const int counts[] = {1024, 2187, 4096, 15625, 32768, 59049, 131072, 177147};
static const double agree = 1e-3; /* of the largest amplitude, to which two spectra do */

Status spectrum_formula(ct_session *session, const Syntax *item, Formula *out, Diag *diag)
{
    if (!spectrum_is_called(item) || item->count != 1 || item->primes > 0) {
        (void)diag_at(diag, E_VALUE, item->place,
                      "spectra are over frequency, and stand beside spectra of one variable each");
        diag_hint(diag, "plot spectrum(h8) spectrum(h9)");
        return E_VALUE;
    }
    TRY(model_check_shown(session->model, item, diag));
    TRY(formula_new(session, item->args[0], out, diag));
    if (item->has_unit)
        out->scale /= item->unit.factor;
    return OK;
}

/* samples become amplitudes, of 0 Hz and then of each whole number of periods in the run */
static Status transform(double *samples, int count, double *amplitudes, Diag *diag)
{
    gsl_fft_real_wavetable *table;
    gsl_fft_real_workspace *room;
    double mean = 0;
    bool sound;

    for (int i = 0; i < count; i++)
        mean += samples[i] / count;
    if (!isfinite(mean))
        return diag_set(diag, E_VALUE,
                        "it isn't a number all through the run, and has no spectrum");
    for (int i = 0; i < count; i++)
        samples[i] = (samples[i] - mean) * (1 - cos(2 * M_PI * i / count));
    /* no call of memory.h while GSL's workspace is allocated */
    table = gsl_fft_real_wavetable_alloc((size_t)count);
    room = gsl_fft_real_workspace_alloc((size_t)count);
    sound = table != NULL && room != NULL &&
            gsl_fft_real_transform(samples, 1, (size_t)count, table, room) == 0;
    gsl_fft_real_workspace_free(room);
    gsl_fft_real_wavetable_free(table);
    if (!sound)
        return diag_set(diag, E_MEMORY, "there is no memory for %d samples", count);
    amplitudes[0] = fabs(mean);
    for (int k = 1; 2 * k < count; k++)
        amplitudes[k] = 2 * hypot(samples[2 * k - 1], samples[2 * k]) / count;
    return OK;
}

/* rows x (columns + 1), the frequency first */
static Status sample(ct_session *session, const Formula *formulas, int columns, Run *grid,
                     Run *source, int count, double *out, Diag *diag)
{
    const double *rows = result_times(grid->result);
    const double span = rows[result_rows(grid->result) - 1] - rows[0];
    const int bins = (count + 1) / 2;
    double *times = NEW_ARRAY(double, count), *values = NEW_ARRAY(double, count);
    double *amplitudes = NEW_ARRAY(double, bins);
    Status status = OK;

    for (int i = 0; i < count; i++)
        times[i] = rows[0] + span * i / count;
    for (int k = 0; k < bins; k++)
        out[(size_t)k * (size_t)(columns + 1)] = k / span;
    for (int c = 0; c < columns; c++) {
        CHECK(
            formula_rows(session, &formulas[c], 1, grid, source, times, count, values, 1, 0, diag));
        CHECK(transform(values, count, amplitudes, diag));
        for (int k = 0; k < bins; k++)
            out[(size_t)k * (size_t)(columns + 1) + (size_t)c + 1] = amplitudes[k];
    }
done:
    MEM_FREE(times, values, amplitudes);
    return status;
}

/* by how much two of them differ, as a part of the largest amplitude: the worst of the columns */
static double difference(const double *coarse, const double *fine, int bins, int columns)
{
    double worst = 0;

    for (int c = 1; c <= columns; c++) {
        double most = 0, apart = 0;

        for (size_t k = 0; k < (size_t)bins; k++) {
            const size_t at = k * (size_t)(columns + 1) + (size_t)c;

            most = fmax(most, fine[at]);
            apart = fmax(apart, fabs(fine[at] - coarse[at]));
        }
        worst = fmax(worst, most > 0 ? apart / most : 0);
    }
    return worst;
}

/* Set amplitudes of a column to 0 that are no larger than the rounding errors of the samples. These
 * are computed at some instants, at distances that no tone of whole periods has */
static Status round_amplitudes(ct_session *session, const Formula *formula, Run *grid, Run *source,
                               double *column, int bins, int stride, Diag *diag)
{
    enum { ASKED = 16 };
    static const double golden = 0.6180339887498949; /* (sqrt(5) - 1)/2, far from any fraction */
    const double *rows = result_times(grid->result);
    const double span = rows[result_rows(grid->result) - 1] - rows[0];
    double most = 0;

    for (int i = 0; i < ASKED; i++) {
        const double at = rows[0] + span * (i * golden - floor(i * golden));
        double open;

        TRY(formula_rounding(session, formula, source, &at, &open, diag));
        most = fmax(most, open);
    }
    for (int k = 0; k < bins; k++, column += stride)
        *column = *column > most ? *column : 0;
    return OK;
}

Status spectrum_rows(ct_session *session, const Formula *formulas, int columns, Run *grid,
                     Run *source, double **values, int *rows, Diag *diag)
{
    const int kept = result_rows(grid->result), last = COUNT(counts) - 1;
    const double resolved = fmax(4.0 * (double)result_report(grid->result)->steps, 2.0 * kept);
    double *coarse = NULL, *fine = NULL, apart = INFINITY;
    Text line = {0};
    int i = 0;
    Status status = OK;

    if (kept < 2 || !(result_times(grid->result)[kept - 1] > result_times(grid->result)[0])) {
        (void)diag_set(diag, E_MISSING, "a spectrum is taken over the last run, and there is none");
        diag_hint(diag, "'simulate 10' makes one");
        return E_MISSING;
    }
    while (i < last - 1 && counts[i] < resolved)
        i++;
    for (;; i++) {
        fine = mem_array((size_t)(counts[i] + 1) / 2 * (size_t)(columns + 1), sizeof *fine);
        CHECK(sample(session, formulas, columns, grid, source, counts[i], fine, diag));
        if (coarse != NULL)
            apart = difference(coarse, fine, (counts[i - 1] + 1) / 2, columns);
        if (apart <= agree || i == last)
            break;
        mem_free(coarse);
        coarse = fine;
        fine = NULL;
    }
    if (apart > agree) {
        text_addf(
            &line,
            "%d samples determine the spectrum to %.2g of its largest amplitude only: there are "
            "tones, or jumps, that more would resolve",
            counts[i], apart);
        session_remark(session, line.at);
        text_free(&line);
    }
    *rows = (counts[i] + 1) / 2;
    for (int c = 0; c < columns; c++)
        CHECK(round_amplitudes(session, &formulas[c], grid, source, fine + c + 1, *rows,
                               columns + 1, diag));
    *values = fine;
    fine = NULL;
done:
    MEM_FREE(coarse, fine);
    return status;
}
