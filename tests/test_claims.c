/* What a file claims is held against its bytes before there is memory for it: axes, factors, descriptions,
 * recipes, packs. */
#include "expect.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "failing_malloc.h"
#include "pack/read.h"
#include "pca/factors_json.h"
#include "scratch.h"
#include "tables/exr_layout.h"

/* No input here is longer than 4 KiB. OpenEXR takes 1 MB or so for itself. */
enum { MOST = 2 << 20 };

static void save(const char *name, const void *bytes, size_t size) {
    FILE *out = fopen(at(name), "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
}

static void save_text(const char *name, const char *text) {
    save(name, text, strlen(text));
}

static void assert_modest(void) {
    if (can_fail()) assert_in_range(largest_asked, 0, MOST);
}

static void assert_says(const lq_error *error, const char *what) {
    if (!strstr(error->text, what)) fail_msg("'%s' does not say '%s'", error->text, what);
}

/* A table whose axis, by a name made shorter, gets a size made longer. */
static void test_axes_of_a_table(void **state) {
    (void)state;
    static const char honest[] = "{\"name\":\"mu-------\",\"size\":3,",
                      lie[] = "{\"name\":\"mu-\",\"size\":1048576,";
    static char bytes[1 << 14];
    lq_axis axis;
    lq_error error = {""};
    lq_table *table;
    const char *channel = "value";
    assert_int_equal(sizeof honest, sizeof lie);
    assert_int_equal(lq_axis_parse(&axis, "mu-------", "0:1:3", &error), LQ_OK);
    assert_int_equal(lq_table_create(&table, &axis, 1, &channel, 1, &error), LQ_OK);
    assert_int_equal(lq_table_write_exr(table, at("claim.exr"), &error), LQ_OK);
    lq_table_free(table);
    lq_axis_free(&axis);
    FILE *in = fopen(at("claim.exr"), "rb");
    const size_t size = fread(bytes, 1, sizeof bytes, in);
    fclose(in);
    char *at_axis = memmem(bytes, size, honest, sizeof honest - 1);
    assert_non_null(at_axis);
    memcpy(at_axis, lie, sizeof lie - 1);
    save("claim.exr", bytes, size);
    largest_asked = 0;
    assert_int_equal(lq_table_read_exr(&table, at("claim.exr"), &error), LQ_FORMAT);
    assert_says(&error, "there is room for");
    assert_modest();
}

/* Each next to nothing as text, together gigabytes. */
static void test_factors(void **state) {
    (void)state;
    static const char factor[] =
        "{\"bases\": 16, \"axes\": [{\"coordinate\": \"axis\", \"axis\": 0, \"other\": 0, \"texels\": "
        "{\"name\": \"mu\", \"size\": %d, \"min\": 0, \"max\": 1, \"map\": \"linear\", \"exponent\": 1}}]}";
    static const char whole[] =
        "{\"axes\": [{\"name\": \"mu\", \"min\": 0, \"max\": 1}], \"value_min\": 0, \"value_max\": 1, "
        "\"pieces\": [{\"min\": [0], \"max\": [1], \"value\": \"plain\", \"value_axis\": 0, "
        "\"factors\": [%s, %s], \"streams\": [{\"factors\": [0], \"index\": [0]}]}]}";
    static const struct {
        int texels;
        size_t most;
        bool fine;
    } all[] = {{4, 128, true}, {4, 127, false}, {1 << 20, 1000, false}, {1000, 1000, false}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char one[512], text[2048];
        lq_error error = {""};
        lq_factored *factored = calloc(1, sizeof *factored);
        snprintf(one, sizeof one, factor, all[i].texels);
        snprintf(text, sizeof text, whole, one, one);
        largest_asked = 0;
        assert_int_equal(lq_factored_from_json(text, all[i].most, factored, &error),
                         all[i].fine ? LQ_OK : LQ_FORMAT);
        assert_modest();
        lq_factored_free(factored);
    }
}

static void test_descriptions(void **state) {
    (void)state;
    static const char *const nodes[] = {"0:1:1048576", "0:1:4096"};
    save_text("values.h", "1, 2, 3, 4");
    for (int i = 0; i < 2; i++) {
        char text[512];
        lq_error error = {""};
        lq_table *table;
        snprintf(text, sizeof text,
                 "{\"table\": \"fgd\", \"axes\": [{\"name\": \"mu\", \"nodes\": \"%s\"}, {\"name\": "
                 "\"alpha\", \"nodes\": "
                 "\"%s\"}, {\"name\": \"n\", \"nodes\": \"0.1:1:16\"}, {\"name\": \"kappa\", \"value\": 1}]}",
                 nodes[i], nodes[i]);
        save_text("axes.json", text);
        char values[4096], axes[4096];
        snprintf(values, sizeof values, "%s", at("values.h"));
        snprintf(axes, sizeof axes, "%s", at("axes.json"));
        largest_asked = 0;
        assert_int_not_equal(lq_table_read_described(&table, values, axes, &error), LQ_OK);
        assert_says(&error, i ? "holds 4 values" : "1048576 nodes");
        assert_modest();
    }
}

static void test_recipes(void **state) {
    (void)state;
    lq_error error = {""};
    lq_recipe *recipe = malloc(sizeof *recipe);
    save_text("recipe.json",
              "{\"name\": \"r\", \"formats\": [\"npy\"], \"tables\": [{\"table\": \"fgd\", \"axes\": "
              "{\"mu\": \"0:1:1048576\", \"n\": \"1\", \"kappa\": \"1\"}}]}");
    largest_asked = 0;
    assert_int_equal(lq_recipe_read(recipe, at("recipe.json"), NULL, &error), LQ_BAD_INPUT);
    assert_says(&error, "accepted are 1 to 16384");
    assert_modest();
    free(recipe);
}

/* ------------------------------------------------------------------ packs */

#define AXIS(NAME, TEXELS)                                                                                   \
    "{\"name\": \"" NAME "\", \"texels\": " TEXELS ", \"min\": 0, \"max\": 1, \"exponent\": 1}"
#define ALBEDO(NAME, TEXELS, MORE)                                                                           \
    "{\"name\": \"" NAME                                                                                     \
    "\", \"table\": \"albedo\", \"axes\": [" AXIS("mu", TEXELS) ", " AXIS("alpha", TEXELS) "], " MORE "}"

static lq_status read_pack(const char *manifest, lq_error *error) {
    static const char numbers[] = "{0, 0.25, 0.5, 1}", atlas[] = "{0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0}";
    lq_pack pack;
    char path[4096];
    save_text("manifest.json", manifest);
    save_text("a.h", numbers);
    save_text("atlas.h", atlas);
    snprintf(path, sizeof path, "%s", at("."));
    largest_asked = 0;
    const lq_status status = lq_pack_read(&pack, path, error);
    if (status == LQ_OK) lq_pack_free(&pack);
    return status;
}

#define FILES "\"files\": [{\"file\": \"a.h\"}]"
#define ATLAS(SIZE)                                                                                          \
    "\"atlas\": {\"width\": " SIZE ", \"height\": " SIZE ", \"files\": [{\"file\": \"atlas.h\"}]}"

static void test_packs(void **state) {
    (void)state;
    lq_error error = {""};
    assert_int_equal(read_pack("{\"pack\": \"p\", \"tables\": [" ALBEDO("a", "2", FILES) "]}", &error),
                     LQ_OK);
    assert_int_equal(read_pack("{\"pack\": \"p\", \"tables\": [" ALBEDO("a", "1048576", FILES) "]}", &error),
                     LQ_FORMAT);
    assert_says(&error, "cannot hold so many texels");
    assert_int_equal(read_pack("{\"pack\": \"p\", \"tables\": [" ALBEDO("a", "4096", FILES) "]}", &error),
                     LQ_FORMAT);
    assert_says(&error, "cannot hold so many texels");
    assert_modest();
    assert_int_equal(read_pack("{\"pack\": \"p\", " ATLAS("16384") ", \"tables\": [" ALBEDO(
                                   "a", "2", "\"tiles\": [[0, 0, 2, 2]]") "]}",
                               &error),
                     LQ_FORMAT);
    assert_says(&error, "cannot hold so many texels");
    assert_modest();
}

/* Every tile is the whole atlas: more than four of them share no texels in a pack of this program. */
static void test_tiles(void **state) {
    (void)state;
    lq_error error = {""};
    char text[1 << 14] = "{\"pack\": \"p\", " ATLAS("2") ", \"tables\": [";
    for (int i = 0; i < 20; i++) {
        char table[512];
        snprintf(table, sizeof table, "%s" ALBEDO("a%d", "2", "\"tiles\": [[0, 0, 2, 2]]"), i ? ", " : "", i);
        strcat(text, table);
    }
    strcat(text, "]}");
    assert_int_equal(read_pack(text, &error), LQ_FORMAT);
    assert_says(&error, "tiles of more texels than the atlas has");
}

static void test_later_versions(void **state) {
    (void)state;
    lq_error error = {""};
    assert_int_equal(
        read_pack("{\"pack\": \"p\", \"version\": 2, \"tables\": [" ALBEDO("a", "2", FILES) "]}", &error),
        LQ_FORMAT);
    assert_says(&error, "later version");
}

static int clear_folder(void **state) {
    static const char *const names[] = {"claim.exr", "values.h",      "axes.json", "recipe.json",
                                        "a.h",       "manifest.json", "atlas.h"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) remove(at(names[i]));
    return remove_folder(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_axes_of_a_table), cmocka_unit_test(test_factors),
        cmocka_unit_test(test_descriptions),    cmocka_unit_test(test_recipes),
        cmocka_unit_test(test_packs),           cmocka_unit_test(test_tiles),
        cmocka_unit_test(test_later_versions),
    };
    return cmocka_run_group_tests(tests, make_folder, clear_folder);
}
