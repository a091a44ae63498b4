/* Text from files: what steers a terminal is taken out of it, JSON is valid whatever it is made of, and facts
 * are limited in number. */
#include "expect.h"
#include "scratch.h"

#include <jansson.h>
#include <string.h>

#include "lacquer.h"
#include "system/json.h"
#include "system/status.h"
#include "system/utf8.h"

static void expect_clean(const char *text, const char *want) {
    char line[64];
    snprintf(line, sizeof line, "%s", text);
    lq_utf8_clean(line, strlen(line), "\n\t");
    assert_string_equal(line, want);
}

static void test_clean(void **state) {
    (void)state;
    expect_clean("plain\ttext\n", "plain\ttext\n");
    expect_clean("\033]0;title\007\033[2J\r\177", " ]0;title  [2J  ");
    expect_clean("gr\303\274n \342\202\254 \360\237\216\250", "gr\303\274n \342\202\254 \360\237\216\250");
    expect_clean("\302\233[2J", "  [2J");             /* CSI as UTF-8 has it */
    expect_clean("\233[2J \377\300\257", "?[2J ???"); /* CSI in 8 bits; no UTF-8; an overlong slash */
    expect_clean("\355\240\200 \364\220\200\200", "??? ????"); /* a surrogate, beyond the last */
    expect_clean("cut \342\202", "cut ??");
}

static void test_whole_characters(void **state) {
    (void)state;
    const char text[] = "a\342\202\254";
    assert_int_equal(lq_utf8_whole(text, 4), 4);
    assert_int_equal(lq_utf8_whole(text, 3), 1);
    assert_int_equal(lq_utf8_whole(text, 2), 1);
    assert_int_equal(lq_utf8_whole(text, 1), 1);
    assert_int_equal(lq_utf8_whole(text, 0), 0);
    assert_int_equal(lq_utf8_whole("\200\200\200\200\200", 5), 5); /* nothing that could become a character */
}

static void test_messages(void **state) {
    (void)state;
    lq_error error;
    lq_fail(&error, LQ_IO, "%s: missing", "a\033[2Jb\302\205c\377");
    assert_string_equal(error.text, "a [2Jb  c?: missing");
}

/* Without the mend: json_pack of such texts and numbers gives NULL, json_object_set_new leaves them out. */
static void test_json_values(void **state) {
    (void)state;
    json_t *root = json_object(), *list = json_array();
    lq_json_append(&list, lq_json_number(NAN));
    lq_json_append(&list, lq_json_number(INFINITY));
    lq_json_append(&list, lq_json_number(0.5));
    lq_json_set(&root, "numbers", list);
    lq_json_set(&root, "text", lq_json_text("\033 \377 \302"));
    char *text = lq_json_dump(root, JSON_COMPACT);
    assert_string_equal(text, "{\"numbers\":[null,null,0.5],\"text\":\"\\u001B \357\277\275 \357\277\275\"}");
    free(text);
}

static void test_json_without_memory(void **state) {
    (void)state;
    json_t *root = json_object();
    lq_json_set(&root, "lost", NULL);
    assert_null(root);
    lq_json_set(&root, "late", json_true());
    assert_null(root);
    assert_null(lq_json_dump(root, 0));
}

static void test_json_reading(void **state) {
    (void)state;
    lq_error error = {""};
    json_t *root;
    assert_int_equal(lq_json_parse(&root, "x.json", "[1,\n2", 5, &error), LQ_FORMAT);
    assert_null(root);
    assert_non_null(strstr(error.text, "x.json:2: not JSON"));
    assert_int_equal(lq_json_parse(&root, "x.json", "{\"a\": 1, \"a\": 2}", 16, &error), LQ_FORMAT);
    assert_int_equal(lq_json_read(&root, folder, &error), LQ_IO);
}

/* ------------------------------------------------------------------ facts, and what the program prints of
 * them */

static lq_table *small_table(void) {
    lq_axis axis;
    lq_table *table;
    const char *channel = "v";
    assert_int_equal(lq_axis_make(&axis, "mu", 0.0, 1.0, 2, LQ_MAP_LINEAR, 1.0, NULL), LQ_OK);
    assert_int_equal(lq_table_create(&table, &axis, 1, &channel, 1, NULL), LQ_OK);
    table->channels[0][0] = table->channels[0][1] = 0.5f;
    lq_axis_free(&axis);
    return table;
}

/* 20,000 of them took quadratic time to set and to read. */
static void test_facts_are_limited(void **state) {
    (void)state;
    lq_table *table = small_table(), *back;
    lq_error error;
    char key[16];
    for (int i = 0; i < LQ_MAX_FACTS; i++) {
        snprintf(key, sizeof key, "f%d", i);
        assert_int_equal(lq_table_set_fact(table, key, key, &error), LQ_OK);
    }
    assert_int_equal(lq_table_set_fact(table, "f", "", &error), LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "accepted are 4096"));
    assert_int_equal(lq_table_set_fact(table, "f7", "seven", &error), LQ_OK); /* replaced */
    assert_int_equal(lq_table_write_exr(table, at("facts.exr"), &error), LQ_OK);
    assert_int_equal(lq_table_read_exr(&back, at("facts.exr"), &error), LQ_OK);
    assert_string_equal(lq_table_fact(back, "f7"), "seven");
    lq_table_free(table);
    lq_table_free(back);
    unlink(at("facts.exr"));
}

/* What `lacquer ARGUMENTS` prints on both streams. */
static size_t run(char *text, size_t size, const char *arguments) {
    char command[1024];
    const char *program = getenv("LACQUER");
    snprintf(command, sizeof command, "'%s' %s 2>&1", program ? program : "build/release/lacquer", arguments);
    FILE *out = popen(command, "r");
    assert_non_null(out);
    const size_t length = fread(text, 1, size - 1, out);
    text[length] = '\0';
    pclose(out);
    return length;
}

static void expect_harmless(const char *text) {
    for (; *text; text++)
        if (((unsigned char)*text < 0x20 && *text != '\n') || *text == 0x7F)
            fail_msg("byte %d is printed", *text);
}

static void test_info_prints_nothing_that_steers(void **state) {
    (void)state;
    char text[8192], arguments[600];
    lq_table *table = small_table();
    table->channels[0][1] = NAN;
    assert_int_equal(lq_table_set_fact(table, "note", "\033]0;evil\007 \302\233 \377 gr\303\274n", NULL),
                     LQ_OK);
    assert_int_equal(lq_table_write_exr(table, at("evil.exr"), NULL), LQ_OK);
    lq_table_free(table);
    snprintf(arguments, sizeof arguments, "info %s", at("evil.exr"));
    run(text, sizeof text, arguments);
    expect_harmless(text);
    assert_non_null(strstr(text, "]0;evil     ? gr\303\274n"));
    snprintf(arguments, sizeof arguments, "info --format json %s", at("evil.exr"));
    json_t *root = json_loadb(text, run(text, sizeof text, arguments), 0, NULL);
    assert_non_null(root);
    json_t *facts = json_object_get(root, "facts");
    assert_int_equal(json_object_size(facts), 1);
    assert_non_null(strstr(json_string_value(json_object_get(facts, "note")), "evil"));
    json_decref(root);
    run(text, sizeof text, "info \"$(printf '\\033]0;evil\\007\\302\\233')\"");
    expect_harmless(text);
    assert_non_null(strstr(text, "]0;evil"));
    unlink(at("evil.exr"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clean),
        cmocka_unit_test(test_whole_characters),
        cmocka_unit_test(test_messages),
        cmocka_unit_test(test_json_values),
        cmocka_unit_test(test_json_without_memory),
        cmocka_unit_test(test_json_reading),
        cmocka_unit_test(test_facts_are_limited),
        cmocka_unit_test(test_info_prints_nothing_that_steers),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
