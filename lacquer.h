/* lacquer.h - make, store and check the look-up tables of layered-material renderers.
 *
 * The one public header. Everything here is plain C17, keeps no global state, prints nothing and
 * never exits. Every fallible function returns an lq_status and, when `error` is not NULL, leaves
 * one line of text there that names the thing, the cause and what would be accepted.
 *
 * References in comments are the keys of REFERENCES.md (B18, D22, H16, ...).
 */
#ifndef LACQUER_H
#define LACQUER_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of the shared library, what this header declares is visible and nothing else is. */
#if defined(__GNUC__)
#pragma GCC visibility push(default)
#endif

/* Threads. The library keeps no state of its own between calls, so several threads may call it at once, on
 * different objects or reading the same one; an object that a call changes or frees belongs to one thread. A
 * call that takes `threads` starts that many of its own (0: one per core, or what OMP_NUM_THREADS says), for
 * as long as it runs, and gives the same bits for any number. Two things are of the process: while tables are
 * factored (lq_pca, lq_pca_search, lq_pack_make) OpenBLAS works on one thread a call, for everybody, and is
 * set back when the last of these calls ends; and an NDF plugin is loaded once, and its functions are called
 * from any thread. */

/* Options. A struct that begins with `struct_size` may grow at its end in later versions. Start from its
 * _default function, or set struct_size to sizeof and the rest to 0: a program that was compiled with an
 * older header works with a newer library, which takes what it does not know of as the default. */

#define LQ_VERSION "0.1.0"

/* That of the library that runs: LQ_VERSION is that of the header. */
const char *lq_version(void);

/* ======================================================================================
 *                                  Status and messages
 * ====================================================================================== */

typedef enum lq_status {
    LQ_OK = 0,
    LQ_BAD_INPUT, /* an argument outside what is accepted */
    LQ_IO,        /* the system refused to open, read, write or rename a file */
    LQ_FORMAT,    /* a file that is not what it should be: foreign, truncated, damaged */
    LQ_NO_MEMORY,
    LQ_CANCELLED,    /* a progress callback asked to stop */
    LQ_NOT_CONVERGED /* the tolerance was not reached; value and error are still valid */
} lq_status;

enum { LQ_MESSAGE_SIZE = 512, LQ_NAME_SIZE = 32, LQ_MAX_AXES = 6, LQ_MAX_CHANNELS = 8, LQ_MAX_FACTS = 4096 };

typedef struct lq_error {
    char text[LQ_MESSAGE_SIZE]; /* one line, no newline, no trailing stop */
} lq_error;

/* Progress of a long call. `report` gets the fraction done, in [0,1], from one thread at a time;
 * returning false cancels the call, which then frees everything and returns LQ_CANCELLED. */
typedef struct lq_progress {
    bool (*report)(void *user, double fraction);
    void *user;
} lq_progress;

/* Watching a call that takes several steps. Any function may be NULL. All are called on the thread that made
 * the call, but `report`, which comes from one thread at a time. */
typedef struct lq_watch {
    size_t struct_size;                          /* sizeof(lq_watch) */
    void (*begin)(void *user, const char *step); /* a step begins: "fgd, check"; `report` is about it */
    bool (*report)(void *user, double fraction); /* as in lq_progress */
    void (*end)(void *user);                     /* the step ended */
    void (*note)(void *user, const char *line);  /* what costs time, not the result: no cache */
    void (*hold)(void *user, bool held);         /* from true to false: ending the process here would leave
                                                  * a temporary folder behind */
    bool (*go_on)(void *user);                   /* asked between steps; false cancels */
    void *user;                                  /* handed to each */
} lq_watch;

/* ======================================================================================
 *                                         Axes
 * ====================================================================================== */

/* How the nodes of an axis are spread: node i of N sits at min + (max - min) w(i / (N - 1)). */
typedef enum lq_map {
    LQ_MAP_LINEAR, /* w(u) = u */
    LQ_MAP_SQRT,   /* w(u) = u^2: the node index goes as the square root of the value */
    LQ_MAP_POWER,  /* w(u) = u^exponent, exponent > 0 */
    LQ_MAP_CUSTOM  /* the nodes are given, strictly increasing */
} lq_map;

typedef struct lq_axis {
    char name[LQ_NAME_SIZE];
    size_t size;     /* number of nodes, >= 1 */
    double min, max; /* first and last node; equal exactly when size is 1 */
    lq_map map;
    double exponent; /* LQ_MAP_POWER: its exponent; 1 and 2 for linear and sqrt; 0 for custom */
    double *nodes;   /* size values, owned by the axis, never NULL in a valid axis */
} lq_axis;

/* Make an axis and compute its nodes (node 0 is exactly min, the last exactly max). `exponent` is
 * read for LQ_MAP_POWER only. Errors: empty or over-long name, size 0 or absurd, min >= max for
 * size > 1, min != max for size 1, anything not finite, exponent <= 0, LQ_MAP_CUSTOM (see below). */
lq_status lq_axis_make(lq_axis *axis, const char *name, double min, double max, size_t size, lq_map map,
                       double exponent, lq_error *error);

/* Make a custom axis from `size` strictly increasing finite nodes (copied). */
lq_status lq_axis_make_custom(lq_axis *axis, const char *name, const double *nodes, size_t size,
                              lq_error *error);

/* Parse what follows `name=` on the command line: "min:max:n", "min:max:n:map" with map one of
 * linear, sqrt, power2.5 (any exponent), a single value "0.3" (one node), or a list "0,0.1,1,3"
 * (custom). */
lq_status lq_axis_parse(lq_axis *axis, const char *name, const char *text, lq_error *error);

/* The fractional node index of `x`, clamped to [0, size-1]: the inverse of the node map. */
double lq_axis_locate(const lq_axis *axis, double x);

lq_status lq_axis_copy(lq_axis *to, const lq_axis *from, lq_error *error);
void lq_axis_free(lq_axis *axis);
const char *lq_map_name(lq_map map);

/* ======================================================================================
 *                                         Tables
 * ====================================================================================== */

/* One fact about how a table was made. Keys are lower case words: "table", "ndf", "scattering",
 * "masking", "interface", "tolerance", "error", "version", "command", ... */
typedef struct lq_fact {
    char *key;
    char *value;
} lq_fact;

/* An N-dimensional table of float32. Data of a channel is one block, FIRST AXIS FASTEST:
 * offset = i0 + size0 (i1 + size1 (i2 + size2 i3)). */
typedef struct lq_table {
    int axis_count;
    lq_axis axes[LQ_MAX_AXES];
    int channel_count;
    char channel_names[LQ_MAX_CHANNELS][LQ_NAME_SIZE];
    float *channels[LQ_MAX_CHANNELS];
    size_t fact_count;
    lq_fact *facts; /* in the order they were set */
} lq_table;

/* A table of zeros over copies of `axes`. Errors: no axis, duplicate names, more entries than the
 * memory of any machine (the message states the size asked for). */
lq_status lq_table_create(lq_table **table, const lq_axis *axes, int axis_count,
                          const char *const *channel_names, int channel_count, lq_error *error);
void lq_table_free(lq_table *table);

/* Entries per channel. */
size_t lq_table_entries(const lq_table *table);
/* The axis called `name`, or -1. */
int lq_table_axis(const lq_table *table, const char *name);

/* Set, replace or look up a fact, of which a table has at most LQ_MAX_FACTS. lq_table_fact returns NULL where
 * there is none. */
lq_status lq_table_set_fact(lq_table *table, const char *key, const char *value, lq_error *error);
const char *lq_table_fact(const lq_table *table, const char *key);

/* Multilinear interpolation at `point` (one coordinate an axis, clamped to the axis range). */
double lq_table_lookup(const lq_table *table, int channel, const double *point);

/* Files. Writers go through a temporary name in the same folder, which becomes `path` only when
 * every byte is on its way to the disk; on any error nothing is left behind and an older file of
 * that name is untouched. The EXR form holds the axes, the facts and float32 data: reading it back
 * gives an identical table. The .npy form is C-ordered with the LAST table axis first (so its last
 * index is the first axis); several channels become a trailing index. */
lq_status lq_table_write_exr(const lq_table *table, const char *path, lq_error *error);
lq_status lq_table_read_exr(lq_table **table, const char *path, lq_error *error);
lq_status lq_table_write_npy(const lq_table *table, const char *path, lq_error *error);

/* A table of anybody's: .npy (float16, float32, float64, C order), EXR (scan lines, one part), or else the
 * numbers of a C array, with a JSON text `description` that says what it is and where its nodes are
 * (docs/foreign.md). The result has the axes of its kind in their order, and the facts stated. LQ_FORMAT
 * where the file is not what is described, LQ_BAD_INPUT where the description is not understood. */
lq_status lq_table_read_described(lq_table **table, const char *path, const char *description,
                                  lq_error *error);

/* Binary layouts that published renderers load (docs/formats.md). None says what it holds: the layout and the
 * kind must be known. A table read from one has the facts of its kind and "layout", but no "tolerance": the
 * file does not say how it was made. "ndf" is that the layout is published for; Mitsuba's is for any, and has
 * no such fact. */
typedef enum lq_layout {
    LQ_BELCOUR, /* sizes, ranges, float32 data, last axis fastest: fgd, tir-pass */
    LQ_TM,      /* the same with the first axis fastest: fgd, tir-loss, albedo (separable masking) */
    LQ_MITSUBA, /* Mitsuba 0.6 .dat, seen from outside: transmission at tau = 1; written whole, below */
    LQ_MITSUBA_INSIDE, /* its second half, seen from inside: transmission, diffuse-transmission */
    LQ_LAYOUTS
} lq_layout;

const char *lq_layout_name(lq_layout layout);

/* LQ_BAD_INPUT where the layout does not store that kind, LQ_FORMAT where the file cannot be such a table:
 * sizes that do not make up its length, ranges that are not finite and ascending. */
lq_status lq_published_read(lq_table **table, const char *path, lq_layout layout, const char *kind,
                            lq_error *error);
/* LQ_BAD_INPUT where the layout cannot hold the table: another kind or masking, an axis that is not linear.
 */
lq_status lq_published_write(const lq_table *table, const char *path, lq_layout layout, lq_error *error);
/* Mitsuba's .dat holds three tables, in the form lq_published_read gives: `outside`, transmission at tau = 1
 * over mu, alpha, eta >= 1, all of them power 4 and mu from 0 to 1; `inside`, the same at 1/eta; `diffuse`,
 * diffuse-transmission at tau = 1 over eta and alpha. The cosine-weighted mean from outside, which the file
 * has as well, is eta^2 times that from inside (reciprocity). */
lq_status lq_mitsuba_write(const lq_table *outside, const lq_table *inside, const lq_table *diffuse,
                           const char *path, lq_error *error);
/* That question alone, before hours of work; `masking` as in the facts of the table to be, or NULL. */
lq_status lq_published_check(lq_layout layout, const char *kind, const char *masking, const lq_axis *axes,
                             int axis_count, lq_error *error);

/* ======================================================================================
 *                               The catalogue of table kinds
 * ====================================================================================== */

typedef enum lq_scattering {
    LQ_SINGLE,  /* one hit on the microsurface, then masking */
    LQ_MULTIPLE /* every number of hits (H16) */
} lq_scattering;

typedef enum lq_masking {
    LQ_CORRELATED, /* height-correlated Smith: G2/G1 = (1+L_i)/(1+L_i+L_o) */
    LQ_SEPARABLE   /* G2/G1 = 1/(1+L_o): older published tables */
} lq_masking;

/* What an axis of a kind means, the values it accepts, and its nodes unless told otherwise. */
typedef struct lq_axis_info {
    const char *name;
    const char *meaning;
    double lowest, highest; /* accepted values, inclusive */
    double min, max;        /* default nodes */
    size_t size;
    lq_map map;
} lq_axis_info;

/* Options a kind listens to; any other one set by the user is refused by name. */
enum { LQ_TAKES_SCATTERING = 1, LQ_TAKES_MASKING = 2 };

typedef struct lq_kind {
    const char *id;
    const char *title;     /* one line */
    const char *quantity;  /* the formula, in plain text */
    const char *source;    /* paper and equation */
    const char *interface; /* "conductor", "dielectric", or NULL where it makes no difference */
    const char *usage;     /* how a renderer uses the number, where conventions differ; NULL: as it is */
    int axis_count;
    lq_axis_info axes[LQ_MAX_AXES];
    int channel_count;
    const char *channels[LQ_MAX_CHANNELS];
    unsigned takes;          /* LQ_TAKES_... */
    double tolerance;        /* default: absolute error of every value */
    double finest_tolerance; /* the smallest that can be asked for */
    double value_min, value_max;
} lq_kind;

size_t lq_kind_count(void);
const lq_kind *lq_kind_at(size_t i);
/* NULL and a message that lists the known ids where there is no such kind. */
const lq_kind *lq_kind_find(const char *id, lq_error *error);

/* The NDFs, by the same pattern. */
size_t lq_ndf_count(void);
const char *lq_ndf_id(size_t i);     /* "ggx", "gtr", "file", ... */
const char *lq_ndf_syntax(size_t i); /* how lq_settings.ndf names one: "gtr:gamma=G" */
const char *lq_ndf_title(size_t i);

/* An NDF, opened: its parameters read, its file or plugin loaded, and what it tabulates kept between calls.
 */
typedef struct lq_ndf lq_ndf;

/* LQ_BAD_INPUT: unknown, parameters out of range, a file with values no NDF has (its line is named), a plugin
 * of another version. LQ_IO, LQ_FORMAT: cannot be read, cannot be loaded. */
lq_status lq_ndf_open(const lq_ndf **ndf, const char *text, lq_error *error);
void lq_ndf_close(const lq_ndf *ndf); /* NULL: nothing */

/* An NDF that a file records (a table, a manifest, a recipe) is data: "file:" and "plugin:" would open, or
 * run, what a stranger chose. Whoever reads such a file says what may be opened. */
typedef struct lq_trust {
    const char *ndf; /* what the user named: a recorded one of this path, or of this hash, is opened */
    bool plugins;    /* any recorded plugin may be loaded */
} lq_trust;

/* Put into `ndf` the text that may be opened for the recorded `text`: that itself, or trust->ndf where both
 * have the same hash. LQ_BAD_INPUT, naming it, where it is not trusted; `trust` NULL: only NDFs that need no
 * file are. The result points into one of the two texts. */
lq_status lq_ndf_trusted(const char *text, const lq_trust *trust, const char **ndf, lq_error *error);

/* The text that opens the same NDF again: every parameter, and the hash of a file's content, without which a
 * changed file would go unnoticed. It is the fact "ndf" of a table. */
const char *lq_ndf_text(const lq_ndf *ndf);
/* What was done to a file or a plugin's D (normalisation, extrapolation), on one line; NULL: nothing. */
const char *lq_ndf_note(const lq_ndf *ndf);
/* The roughnesses it has besides alpha = 0; equal: it has only this one, and tables one node of alpha. */
void lq_ndf_range(const lq_ndf *ndf, double *alpha_min, double *alpha_max);

/* ======================================================================================
 *                                        Plugins
 * ====================================================================================== */

/* clang-format off */
/* An NDF of your own: a shared object with this function, opened as "plugin:PATH.so" (docs/tutorial-ndf.md).
 *
 *     #include <lacquer.h>
 *     static void density(double alpha, size_t count, const double *cos2, const double *sin2, double *d)
 *     {
 *         ...
 *     }
 *     const lq_ndf_plugin *lacquer_ndf_plugin(void)
 *     {
 *         static const lq_ndf_plugin plugin = {LQ_NDF_PLUGIN_VERSION, sizeof plugin, "title", "source",
 *                                              0.0, 1.0, density};
 *         return &plugin;
 *     }
 *
 *     cc -O2 -shared -fPIC plugin.c -o plugin.so
 */
/* clang-format on */
#define LQ_NDF_PLUGIN_VERSION 1

typedef struct lq_ndf_plugin {
    unsigned version;            /* LQ_NDF_PLUGIN_VERSION */
    size_t struct_size;          /* sizeof(lq_ndf_plugin) */
    const char *title, *source;  /* one line each, or NULL */
    double alpha_min, alpha_max; /* roughnesses it has besides 0, in [0,1]; equal: only this one */
    /* D, in any scale, of `count` normals given by cos^2 and sin^2 of their angle to the z axis, for
     * 0 < alpha <= 1: finite and >= 0, D about as wide as slopes of `alpha`. Called from any thread. */
    void (*density)(double alpha, size_t count, const double *cos2, const double *sin2, double *d);
} lq_ndf_plugin;

/* Defined by the plugin, not by this library. */
const lq_ndf_plugin *lacquer_ndf_plugin(void);

/* ======================================================================================
 *                                      Computation
 * ====================================================================================== */

#define LQ_LOOSEST_TOLERANCE 0.1 /* the largest that can be asked of any kind */

typedef struct lq_settings {
    size_t struct_size; /* sizeof(lq_settings); lq_settings_default sets it */
    const char *ndf;    /* "ggx"; see lq_ndf_open */
    lq_scattering scattering;
    lq_masking masking;
    double tolerance;     /* absolute error of every value; 0: the kind's default */
    int threads;          /* 0: one per core. Results do not depend on it. */
    const lq_ndf *opened; /* `ndf`, opened; NULL: every call opens it */
} lq_settings;

lq_settings lq_settings_default(void);

/* One point, computed exactly. `point` has one coordinate per axis of the kind, in its order;
 * `values` gets one number per channel, `error` (of all channels) an estimate that is meant never
 * to fall below the distance to the exact integral. LQ_NOT_CONVERGED: the estimate is above the
 * tolerance; the numbers stand. */
lq_status lq_eval(const lq_kind *kind, const lq_settings *settings, const double *point, double *values,
                  double *estimate, lq_error *error);

/* A whole table over `axes` (one per axis of the kind, in its order and under its names), on all
 * cores. Its facts say how it was made; fact "error" is the largest error estimate over it, to
 * which storage in float32 adds fact "rounding". */
lq_status lq_precompute(const lq_kind *kind, const lq_settings *settings, const lq_axis *axes,
                        const lq_progress *progress, lq_table **table, lq_error *error);

/* All of a Mitsuba 0.6 .dat (lq_mitsuba_write) computed and written: transmission seen from outside over
 * `axes` (mu, alpha, eta, tau: lq_mitsuba_axes gives those of the published files in place of what `axes`
 * holds), from inside over their 1/eta, and cosine-weighted means. `entries` and `estimate`, the largest
 * error estimate, are of all of them. LQ_NOT_CONVERGED: written, but above the tolerance. */
lq_status lq_mitsuba_axes(lq_axis *axes, lq_error *error);
lq_status lq_mitsuba_precompute(const lq_settings *settings, const lq_axis *axes, const lq_progress *progress,
                                const char *path, size_t *entries, double *estimate, lq_error *error);

/* What made a table, from its facts: its kind, and settings that compute the same again.
 * `trust` (may be NULL) says which recorded NDF may be opened. settings->ndf points into the facts or the
 * trust. LQ_BAD_INPUT: an NDF that is not trusted. LQ_FORMAT: a fact is missing or unknown, or axes and
 * channels are not those of the kind. */
lq_status lq_table_settings(const lq_table *table, const lq_trust *trust, const lq_kind **kind,
                            lq_settings *settings, lq_error *error);

/* The default axes of a kind. Free each with lq_axis_free. */
lq_status lq_kind_axes(const lq_kind *kind, lq_axis *axes, lq_error *error);
/* The same for the NDF of these settings: where it has only some roughnesses, alpha runs over those, and
 * where it has one, alpha is that one node. */
lq_status lq_settings_axes(const lq_kind *kind, const lq_settings *settings, lq_axis *axes, lq_error *error);

/* Energy that leaves after exactly 1, 2, ... `count` hits of a conductor's microsurface; the sum
 * over all orders is FGD-infinity. point: mu, alpha, n, kappa. */
lq_status lq_eval_orders(const lq_settings *settings, const double *point, size_t count, double *energies,
                         lq_error *error);

/* The same value by random walks on the microsurface (H16), which share the NDF and the Fresnel equations
 * with the solvers and nothing else: `values` gets one mean a channel of `samples` walks (at least 2),
 * `noise` its standard error, where rare events that no walk may have met count as well. They depend on
 * `seed`, never on threads. LQ_BAD_INPUT: a point outside the kind, an NDF that is not there. */
lq_status lq_eval_walk(const lq_kind *kind, const lq_settings *settings, const double *point, size_t samples,
                       unsigned long long seed, double *values, double *noise, lq_error *error);

/* ======================================================================================
 *                                   Factored tables
 * ======================================================================================
 *
 * A table as sums of products of small textures (D22 sec. 4), in the form a shader evaluates:
 *
 *     clamp x to the table's axes; take the first piece whose box contains x
 *     stream_k = sum over terms  product over factors g  of  base index[term][g] of factor g, filtered
 *     value    = clamp(piece's value transform of its streams, value_min, value_max)
 *
 * A factor is one 1D or 2D texture set: `base_count` images over the same texels. End points of an axis sit
 * on texel centres, u = (index (1 - 1/N) + 0.5/N) with index in [0,1], filtering is linear, addressing
 * clamps.
 */

enum { LQ_MAX_STREAMS = 2, LQ_MAX_FACTORS = 8, LQ_MAX_PIECES = 8 };

/* What a texture axis measures, from the table's point x. */
typedef enum lq_coordinate {
    LQ_COORDINATE_AXIS,     /* x[axis] */
    LQ_COORDINATE_CRITICAL, /* mu = x[axis] from the critical cosine c = sqrt(max(1 - eta^2, 0)), eta =
                             * x[other]: mu < c ? -sqrt(1 - mu / c) : sqrt((mu - c) / (1 - c)), in [-1, 1] */
    LQ_COORDINATE_COSINE,   /* the critical cosine c itself, of eta = x[axis] */
    LQ_COORDINATES
} lq_coordinate;

typedef struct lq_texture_axis {
    lq_coordinate coordinate;
    int axis, other; /* of the table; `other` only where the coordinate reads it */
    lq_axis texels;  /* map linear, sqrt or power; node i is the centre of texel i; name: the coordinate's */
} lq_texture_axis;

typedef struct lq_factor {
    int axis_count; /* 1 or 2 */
    lq_texture_axis axes[2];
    size_t base_count;
    float *data; /* data[(base * height + row) * width + column], column along axes[0]; all exact in half */
} lq_factor;

/* sum over t < term_count of the product over g < factor_count of base index[t * factor_count + g] of the
 * piece's factor factors[g]. */
typedef struct lq_term_sum {
    size_t term_count;
    int factor_count;
    int factors[LQ_MAX_FACTORS];
    unsigned short *index;
} lq_term_sum;

/* Streams into the value. */
typedef enum lq_value {
    LQ_VALUE_PLAIN,  /* stream 0 */
    LQ_VALUE_SQUARE, /* stream 0 squared */
    LQ_VALUE_BEER,   /* stream 0 * t^(2^(stream 1)), t = x[value_axis] in [0,1]: the energy of a crossing and
                      * the logarithm of its effective path */
    LQ_VALUES
} lq_value;

typedef struct lq_piece {
    double min[LQ_MAX_AXES], max[LQ_MAX_AXES]; /* its box on the table's axes, both ends included */
    lq_value value;
    int value_axis; /* LQ_VALUE_BEER: the axis of t */
    int factor_count;
    lq_factor factors[LQ_MAX_FACTORS];
    int stream_count;
    lq_term_sum streams[LQ_MAX_STREAMS];
} lq_piece;

typedef struct lq_factored {
    int axis_count;
    struct {
        char name[LQ_NAME_SIZE];
        double min, max;
    } axes[LQ_MAX_AXES];
    double value_min, value_max; /* the physical range every value is clamped to */
    int piece_count;
    lq_piece pieces[LQ_MAX_PIECES];
    size_t fact_count;
    lq_fact *facts; /* those of the table it came from, and the error report: "pca-max", ... */
} lq_factored;

/* Value at a point: in double with exact interpolation weights, or as a GPU gets it: single precision and
 * filter weights of 8 fractional bits. */
double lq_factored_lookup(const lq_factored *factored, const double *point);
double lq_factored_lookup_gpu(const lq_factored *factored, const double *point);

/* Bytes of all bases stored in half. */
size_t lq_factored_bytes(const lq_factored *factored);

/* Its fact, or NULL; set or replace one. */
const char *lq_factored_fact(const lq_factored *factored, const char *key);
lq_status lq_factored_set_fact(lq_factored *factored, const char *key, const char *value, lq_error *error);
void lq_factored_free(lq_factored *factored);

/* One file, an EXR archive: reading back gives an identical factored table. LQ_FORMAT where the file holds a
 * table and no factors. */
lq_status lq_factored_write(const lq_factored *factored, const char *path, lq_error *error);
lq_status lq_factored_read(lq_factored **factored, const char *path, lq_error *error);

/* --------------------------------------------------------------------------------------
 * Making them
 * -------------------------------------------------------------------------------------- */

typedef enum lq_scheme {
    LQ_SEQUENTIAL, /* D22 sec. 4: one axis after the other, each by singular vectors */
    LQ_JOINT       /* all factors fitted together */
} lq_scheme;

/* One or two axes taken out of the table together, as so many bases (each of those of the axis before). */
typedef struct lq_separation {
    int axis_count;
    int axes[2];
    size_t bases;
} lq_separation;

typedef struct lq_pca_options {
    size_t struct_size; /* sizeof(lq_pca_options); that of an older header is read as far as it goes */
    lq_scheme scheme;
    int separation_count; /* what stays is the plane: 1 or 2 axes */
    lq_separation separations[LQ_MAX_AXES];
    lq_value value;               /* LQ_JOINT only, as all below */
    int value_axis;               /* LQ_VALUE_BEER: that of tau */
    size_t bases[LQ_MAX_STREAMS]; /* of the plane, for each stream; 0: the product of the separations' */
    size_t pairs;                 /* two axes separated: products of lines that make one base of both */
    bool critical;                /* plane mu, eta: mu is measured from the critical cosine, eta by it */
    double power;                 /* of the error that is minimised: 2 is rms, 8 close to the largest */
    int sweeps;
    size_t texels[LQ_MAX_AXES];    /* of each axis; 0: one a node */
    double exponents[LQ_MAX_AXES]; /* of the map of the texels: 1 linear, 2 sqrt, ...; 0: that of the table */
    int split_axis, split_count;   /* pieces: the table is cut at nodes of one axis */
    double splits[LQ_MAX_PIECES - 1];
    int threads; /* of a fit or a search; 0: one per core. Results do not depend on it. */
} lq_pca_options;

lq_pca_options lq_pca_options_default(void);

/* Factor one channel of a table. While it runs, BLAS of the process works on one thread a call; afterwards on
 * as many as before. Several threads may factor tables at once. */
lq_status lq_pca(const lq_table *table, int channel, const lq_pca_options *options,
                 const lq_progress *progress, lq_factored **factored, lq_error *error);

/* Errors of lq_factored_lookup_gpu against a table of the same axes (any nodes), at all its nodes. */
typedef struct lq_pca_errors {
    size_t points;
    double rms, p99, max;
    double worst[LQ_MAX_AXES]; /* where max is */
} lq_pca_errors;

lq_status lq_factored_errors(const lq_factored *factored, const lq_table *exact, int channel,
                             lq_pca_errors *errors, lq_error *error);

typedef enum lq_pca_norm { LQ_PCA_MAX, LQ_PCA_RMS, LQ_PCA_P99 } lq_pca_norm;

/* What a search is after, and how it gets exact values. */
typedef struct lq_pca_goal {
    size_t struct_size;
    lq_pca_norm norm;
    double budget; /* the smallest factors within it; 0: the most exact within `bytes` */
    size_t bytes;  /* 0: any */
    /* Exact values at points of its own choice within a box of the axes, as a table; NULL: the table's nodes
     * inside the box serve. */
    lq_status (*exact)(void *user, const double *min, const double *max, lq_table **values, lq_error *error);
    void *user;
} lq_pca_goal;

/* One factorisation a search tried, of one piece. */
typedef struct lq_pca_try {
    int piece;
    lq_pca_options options;
    size_t bytes;
    lq_pca_errors errors;
    bool chosen;
} lq_pca_try;

/* Search ranks, separations, transforms and texture sizes, for each piece that `start` (splits, sweeps) asks
 * for. `tries` gets what was tried, free() it. LQ_NOT_CONVERGED: the budget was not met; the best is given.
 */
lq_status lq_pca_search(const lq_table *table, int channel, const lq_pca_options *start,
                        const lq_pca_goal *goal, const lq_progress *progress, lq_factored **factored,
                        lq_pca_try **tries, size_t *try_count, lq_error *error);

/* ======================================================================================
 *                                         Packs
 * ======================================================================================
 *
 * A folder of textures, decode source in shading languages, published binaries and a manifest that says how
 * each was made and how far it is off: what an engine loads (docs/packs.md).
 */

typedef struct lq_pack_options {
    size_t struct_size;    /* sizeof(lq_pack_options); lq_pack_options_default sets it */
    const char *cache;     /* a folder of tables computed before, made where it is missing; NULL: none */
    lq_trust trust;        /* NDF files and plugins that the recipe may name; by default none */
    int threads;           /* 0: one per core. The files do not depend on it. */
    const lq_watch *watch; /* NULL: nobody */
} lq_pack_options;

lq_pack_options lq_pack_options_default(void);

/* What one table or material came to. Errors are those of what a GPU decodes, from halves and filter weights
 * of 8 fractional bits, against exact values at points off the grid, from mu, alpha and tau of 0.02 up. */
typedef struct lq_pack_entry {
    char name[LQ_NAME_SIZE];
    bool material;                 /* of a scene; otherwise a table */
    int line;                      /* in the recipe */
    size_t bytes;                  /* of its textures, as a GPU holds them */
    size_t points;                 /* where it was measured */
    bool relative;                 /* errors are relative (mappings); otherwise absolute */
    double rms, p99, max;          /* over all points and channels */
    double budget_p99, budget_max; /* what the recipe asks; INFINITY: nothing */
    char refine[LQ_NAME_SIZE]; /* the axis whose texels bend most where the error is largest; "": not known */
} lq_pack_entry;

typedef struct lq_pack_report lq_pack_report;

/* Make the pack of a recipe's file: everything is computed or found in the cache, measured, and put into
 * `folder`, which is new, empty, or an older pack with nothing changed, and which appears whole or stays as
 * it was. `options` NULL: the defaults. `report` (may be NULL) gets what it came to wherever that is known,
 * the tables of the recipe first, then its materials; free it. LQ_NOT_CONVERGED: a budget is missed, which
 * the message names, and nothing was written. LQ_BAD_INPUT, LQ_FORMAT: "FILE:LINE: what; accepted: ...".
 * LQ_IO: the folder is somebody's, or cannot be written. LQ_CANCELLED: by the watch. */
lq_status lq_pack_make(const char *recipe, const char *folder, const lq_pack_options *options,
                       lq_pack_report **report, lq_error *error);

size_t lq_pack_report_count(const lq_pack_report *report);
const lq_pack_entry *lq_pack_report_entry(const lq_pack_report *report, size_t i); /* NULL beyond the last */
/* Of all textures as a GPU holds them, the borders of an atlas included. `atlas` (may be NULL): whether they
 * are in one. */
size_t lq_pack_report_bytes(const lq_pack_report *report, bool *atlas);
void lq_pack_report_free(lq_pack_report *report); /* NULL: nothing */

/* ---- What a pack decodes to ---- */

/* A pack, read back: the manifest and the texels of its files. */
typedef struct lq_pack lq_pack;

/* Whether a folder holds a manifest. */
bool lq_pack_found(const char *folder);

/* Every file of texels is read and compared with the others. LQ_FORMAT names one that is missing or not what
 * the manifest says, LQ_IO one that cannot be read. */
lq_status lq_pack_open(lq_pack **pack, const char *folder, lq_error *error);
void lq_pack_close(lq_pack *pack); /* NULL: nothing */

enum { LQ_PACK_VALUES = 12 };

typedef struct lq_pack_axis {
    const char *name;
    double min, max; /* what the function takes; beyond, it takes the end */
} lq_pack_axis;

/* A function of the decode source, of a table or of a material. */
typedef struct lq_pack_function {
    const char *name;    /* "car-paint"; the source calls it lacquer_car_paint */
    const lq_kind *kind; /* NULL: a material */
    int axis_count;
    lq_pack_axis axes[LQ_MAX_AXES];
    int value_count;
    const char *values[LQ_PACK_VALUES]; /* channels of the table; of a material the colours and the roughness
                                         * of three lobes: "top.r" ... "base_alpha" */
} lq_pack_function;

/* Tables in the order of the recipe, then materials. All belong to the pack. */
size_t lq_pack_function_count(const lq_pack *pack);
const lq_pack_function *lq_pack_function_at(const lq_pack *pack, size_t i); /* NULL beyond the last */
/* By its name, or that of its source. LQ_BAD_INPUT lists those there are. */
lq_status lq_pack_find(const lq_pack *pack, const char *name, size_t *function, lq_error *error);

/* What function `function` returns at a point, one coordinate an axis, on a GPU: halves, and filter weights
 * of 8 fractional bits. */
void lq_pack_decode(const lq_pack *pack, size_t function, const double *point, double *values);

/* The cache of `lacquer pack`: lacquer in XDG_CACHE_HOME or ~/.cache. False: neither is set, or it does not
 * fit into `size` bytes. */
bool lq_cache_default(char *folder, size_t size);

/* ======================================================================================
 *                                      Certificates
 * ======================================================================================
 *
 * How far what a renderer decodes is from the exact solver, anywhere in a domain, and how sure that is
 * (docs/certificates.md): points drawn between the nodes, a search from the worst of them, physics that
 * values owe.
 */

typedef struct lq_certify_options {
    size_t struct_size; /* sizeof(lq_certify_options); lq_certify_options_default sets it */
    const char *budget; /* "max=1e-2,p99=2e-3,rms=...,mean=...", or one number, for max; NULL: none, or that
                         * of a pack */
    const char *budget_file; /* instead: a file of budgets by table; NULL: none */
    const char *domain; /* "mu=0.02:1,tau=0.02:1": the part of the axes that counts; NULL: all of them, of a
                         * pack what its manifest promises */
    const char *table;  /* of a factor file: the table that it was made from, for the parts of its error */
    bool parts;         /* of a pack: compute the tables of its factors anew, for the same */
    size_t points;      /* at least; 0: 100000, or 1024 where every value is a solve of its own */
    double tolerance;   /* of the exact values; 0: 1e-4, or a twentieth of the budget */
    unsigned long long seed; /* of the points; 1 by default */
    int threads;             /* 0: one per core. Results do not depend on it. */
    lq_trust trust;          /* which recorded NDFs may be opened */
    const lq_watch *watch;   /* NULL: nobody */
} lq_certify_options;

lq_certify_options lq_certify_options_default(void);

typedef enum lq_outcome { LQ_PASSED, LQ_FAILED, LQ_NOTED /* measured, not judged */ } lq_outcome;

/* One judgement. */
typedef struct lq_check {
    char name[40]; /* "budget max", "range decoded" */
    lq_outcome outcome;
    double value, limit; /* limit NAN: none */
    char detail[240];    /* where, or how sure */
} lq_check;

/* Of one table, or of one material of a pack. */
typedef struct lq_certificate {
    const char *name;
    const lq_kind *kind; /* NULL: a material */
    bool passed;
    size_t points;        /* exact values it rests on */
    bool relative;        /* errors are relative (mappings); otherwise absolute */
    double rms, p99, max; /* over all points and channels; max also over what the search found */
    double p99_limit;     /* p99 of the domain is below, with 95 % confidence; INFINITY: not settled */
    double estimate;      /* largest error estimate of the exact values; 0: of a material */
    size_t check_count;
    const lq_check *checks;  /* of a material: none, its budget alone decides */
    const lq_check *failure; /* the first that failed, or NULL */
} lq_certificate;

typedef struct lq_certificates lq_certificates;

/* Certify what is at `path`: a table or a factor file of this library, a folder of such files, or a pack.
 * `options` NULL: the defaults. That something failed is no error: see lq_certificates_passed. LQ_BAD_INPUT:
 * an option that is not understood, an NDF that is not trusted, a range that the kind has not. LQ_FORMAT,
 * LQ_IO: a file that is not one of these, or cannot be read. LQ_CANCELLED: by the watch. */
lq_status lq_certify(const char *path, const lq_certify_options *options, lq_certificates **certificates,
                     lq_error *error);
void lq_certificates_free(lq_certificates *certificates); /* NULL: nothing */

size_t lq_certificates_count(const lq_certificates *certificates);
/* Tables first, then materials; what it points to belongs to the list. False: beyond the last. */
bool lq_certificates_get(const lq_certificates *certificates, size_t i, lq_certificate *certificate);
bool lq_certificates_passed(const lq_certificates *certificates);

/* As JSON (free() the text), as JUnit XML with a test case a judgement, and as a web page, folder/index.html,
 * which needs no other file. `date`, "2026-11-26", is what the page tells; NULL: none. Files appear whole or
 * not at all. */
lq_status lq_certificates_json(const lq_certificates *certificates, char **text, lq_error *error);
lq_status lq_certificates_junit(const lq_certificates *certificates, const char *path, lq_error *error);
lq_status lq_certificates_page(const lq_certificates *certificates, const char *folder, const char *date,
                               lq_error *error);

/* ======================================================================================
 *                                        Stacks
 * ======================================================================================
 *
 * A layered material, read from the top. Indices are absolute, angles in degrees.
 *
 *     {"name": "frosted-metal",
 *      "layers": [{"dielectric": {"n": 1.5, "alpha": 0.2}, "medium": {"tau": [0.8, 0.5, 0.3]}},
 *                 {"conductor": {"n": 0.2, "kappa": 3.9, "alpha": 0.05}}]}
 */

enum { LQ_STACK_CHANNELS = 3, LQ_MAX_LAYERS = 4096, LQ_NDF_TEXT_SIZE = 256, LQ_STACK_NAME_SIZE = 128 };

typedef enum lq_quantity_form { LQ_ONE, LQ_RGB, LQ_RANGE } lq_quantity_form;

/* A number of a description: one value, one a channel, or (scenes) a range. */
typedef struct lq_quantity {
    lq_quantity_form form;
    double value[LQ_STACK_CHANNELS]; /* LQ_ONE: three times the same; LQ_RANGE: the lower end */
    double highest;                  /* LQ_RANGE: the upper end */
} lq_quantity;

/* What lies below a dielectric, down to the next interface; light crosses that of the last one, too. */
typedef struct lq_medium {
    bool by_sigma;                       /* said by sigma_a, sigma_s, depth and g, not by tau */
    lq_quantity tau;                     /* transmittance at normal incidence, in [0,1]; 1: vacuum */
    lq_quantity sigma_a, sigma_s, depth; /* absorption and scattering per unit of depth */
    lq_quantity g;                       /* Henyey-Greenstein, in (-1,1) */
} lq_medium;

typedef enum lq_layer_type { LQ_LAYER_DIELECTRIC, LQ_LAYER_CONDUCTOR, LQ_LAYER_LAMBERTIAN } lq_layer_type;

typedef struct lq_layer {
    lq_layer_type type;
    lq_quantity n;                /* dielectric: of the medium below, in (0,10]; conductor: [0,100] */
    lq_quantity kappa;            /* conductor, in [0,100] */
    bool anisotropic;             /* alpha_x and alpha_y were given apart */
    lq_quantity alpha_x, alpha_y; /* in [0,1], equal where isotropic */
    lq_quantity rotate;           /* of the x axis about the normal */
    lq_quantity rho;              /* lambertian: albedo in [0,1] */
    char ndf[LQ_NDF_TEXT_SIZE];   /* see lq_ndf_open */
    lq_medium medium;             /* dielectric */
} lq_layer;

typedef struct lq_stack {
    char name[LQ_STACK_NAME_SIZE]; /* "" where it has none */
    size_t layer_count;
    lq_layer *layers; /* layers[0] is the top; all but the last are dielectric */
} lq_stack;

/* LQ_STACK_RANGES: ranges are accepted, for scenes. LQ_STACK_TRUSTED: the files and plugins that an "ndf"
 * names may be opened; by default a description is data, and such an NDF is refused by name. */
enum { LQ_STACK_RANGES = 1, LQ_STACK_TRUSTED = 2 };

/* Messages name file, line, layer, cause and what is accepted. `name` stands for the file in those of
 * lq_stack_parse. LQ_FORMAT: no JSON; LQ_BAD_INPUT: no stack. Free the stack. */
lq_status lq_stack_read(lq_stack **stack, const char *path, unsigned flags, lq_error *error);
lq_status lq_stack_parse(lq_stack **stack, const char *text, const char *name, unsigned flags,
                         lq_error *error);
/* Back as JSON on one line, which reads as the same stack; free() it. */
lq_status lq_stack_text(const lq_stack *stack, char **text, lq_error *error);
lq_status lq_stack_copy(lq_stack **copy, const lq_stack *stack, lq_error *error);
void lq_stack_free(lq_stack *stack); /* NULL: nothing */

/* One parameter, in all channels: "LAYER.NAME", LAYER top, base or a number counted from 1 at the top, NAME
 * n, kappa, alpha, alpha.x, alpha.y, alpha.rotate, rho, tau, sigma_a, sigma_s, depth or g. */
lq_status lq_stack_set(lq_stack *stack, const char *path, double value, lq_error *error);
/* What that parameter accepts, both ends included unless they are the 0 of an index or the 1 of g. */
lq_status lq_stack_range(const lq_stack *stack, const char *path, double *lowest, double *highest,
                         lq_error *error);

/* ---- What a stack does to light ---- */

/* Light that leaves on one side. `mean` counts positive away from the light: a mirror has sin theta_i. */
typedef struct lq_stack_lobe {
    double energy; /* flux that leaves / flux that arrives */
    double sin2;   /* flux-weighted means over it, in the medium it leaves into: E[sin^2 theta], */
    double mean;   /* E[sin theta cos phi], */
    double across; /* E[sin^2 theta sin^2 phi]; all three 0 where there is no light */
} lq_stack_lobe;

typedef struct lq_stack_light {
    lq_stack_lobe reflected, transmitted; /* to the light's side, to the other */
    double error; /* an estimate for every number above, never meant to be too small */
} lq_stack_light;

typedef struct lq_stack_query {
    const double *mu; /* cosines of incidence, in the medium the light comes from */
    size_t mu_count;
    bool from_below;  /* lit through the last medium, of a stack that ends with a dielectric */
    bool single;      /* the first hit at every interface alone: what is blocked after it is lost */
    size_t paths;     /* 0, or split light by its events on the first interface it meets (Ba19 sec. 5.3) */
    double tolerance; /* of every number; 0: 1e-4 */
    int threads;      /* 0: one per core. Results do not depend on it. */
} lq_stack_query;

/* 3 where any number of the description is [r, g, b], otherwise 1. */
int lq_stack_channels(const lq_stack *stack);

/* Exact, by adding layers as operators on cosines (B18 sec. 5.1; docs/theory.md, "Stacks"): all orders of
 * scattering at every interface, all reflections between them, media absorb tau^(1/mu) along straight lines.
 * light[(m * channels + c)], or with paths light[(m * channels + c) * paths + p]: p = 0 is what the first
 * interface reflects or lets through at once, p the light that met it p + 1 times; the last holds all the
 * rest. LQ_BAD_INPUT: a cosine outside [0,1], light from below an opaque base, and what is not solved: an
 * anisotropic interface, a medium that scatters, a range. LQ_NOT_CONVERGED: some estimate is above the
 * tolerance; `light` is filled. */
lq_status lq_stack_solve(const lq_stack *stack, const lq_stack_query *query, lq_stack_light *light,
                         const lq_progress *progress, lq_error *error);

/* How many paths leave no more than `least` of the light to the last one, at every cosine and channel of the
 * query (its own paths are not read): 2 to LQ_STACK_PATHS_MAX, from the coarsest level. */
enum { LQ_STACK_PATHS_MAX = 64 };
lq_status lq_stack_count_paths(const lq_stack *stack, const lq_stack_query *query, double least,
                               size_t *paths, lq_error *error);

/* A table over "mu" and any parameters of the layers, named as by lq_stack_set ("top.alpha"); `query` says
 * the rest, its cosines and paths are not read. Channels: reflected, sin2, mean and across, then the same of
 * transmitted light where there is some; of a stack in RGB the energies alone, reflected.r, .g and .b,
 * transmitted.r, .g and .b. The fact "stack" holds the description. LQ_NOT_CONVERGED: the table is there, and
 * its fact "error" says how far off. */
lq_status lq_stack_precompute(const lq_stack *stack, const lq_stack_query *query, const lq_axis *axes,
                              int axis_count, const lq_progress *progress, lq_table **table, lq_error *error);

/* ---- The same by chance ---- */

typedef struct lq_stack_walked {
    lq_stack_light light; /* means over the walks; its `error` is what they did not follow */
    lq_stack_lobe reflected_noise, transmitted_noise; /* standard errors of these means */
} lq_stack_walked;

enum { LQ_STACK_WALK_PATHS = 4 };

/* Random walks of single rays, an independent check of lq_stack_solve: it takes the same queries (their
 * tolerance aside; paths up to LQ_STACK_WALK_PATHS), refuses the same stacks and numbers its results the same
 * way. These depend on `seed` and `samples` (at least 2), never on threads. A ray is given up after a million
 * hits; it is missing from every mean, and `light.error` is the energy that such rays carried. */
lq_status lq_stack_walk(const lq_stack *stack, const lq_stack_query *query, size_t samples, size_t seed,
                        lq_stack_walked *walked, const lq_progress *progress, lq_error *error);

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#ifdef __cplusplus
}
#endif
#endif
