/* DDS files of every shape, read by OpenSceneGraph (sizes, format, every texel) and by nvddsinfo of NVIDIA's
 * texture tools (header, arrays). Skipped where neither is there. */
#include "tests/expect.h"
#include "tests/scratch.h"

#include "pack/image.h"

#include <stdint.h>
#include <string.h>

enum { OUTPUT = 1 << 16 };

static bool have(const char *tool) {
    char command[64];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", tool);
    return system(command) == 0;
}

/* Values that differ from texel to texel and from channel to channel, exact in half. */
static lq_image make(size_t width, size_t height, size_t depth, size_t layers, int channels, bool single) {
    lq_image image;
    lq_error error = {""};
    assert_int_equal(lq_image_create(&image, width, height, depth, layers, channels, &error), LQ_OK);
    image.single = single;
    const size_t count = lq_image_texels(&image) * (size_t)channels;
    for (size_t i = 0; i < count; i++) image.data[i] = (float)(i + 1) * (i % 3 == 0 ? -0.0625f : 0.0625f);
    if (!single) assert_int_equal(lq_image_to_half(&image, "t", &error), LQ_OK);
    assert_int_equal(lq_image_write(&image, LQ_CONTAINER_DDS, "t", at("t.dds"), &error), LQ_OK);
    return image;
}

static void run(const char *command, char *output) {
    char line[600];
    snprintf(line, sizeof line, "cd %s && %s", folder, command);
    FILE *in = popen(line, "r");
    assert_non_null(in);
    const size_t size = fread(output, 1, OUTPUT - 1, in);
    output[size] = '\0';
    assert_int_equal(pclose(in), 0);
}

/* Base 64 up to the closing quote, line ends left out. */
static size_t decode(const char *text, unsigned char *bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t bits = 0;
    size_t count = 0;
    int held = 0;
    for (; *text && *text != '"' && *text != '='; text++) {
        const char *digit = strchr(digits, *text);
        if (!digit) continue;
        bits = bits << 6 | (uint32_t)(digit - digits);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes[count++] = (unsigned char)(bits >> held);
    }
    return count;
}

/* The value of a half: the sign, and a magnitude of 11 bits. */
static float half_value(const unsigned char *bytes) {
    const int bits = bytes[0] | bytes[1] << 8, exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const float magnitude =
        exponent ? ldexpf((float)(1024 + mantissa), exponent - 25) : ldexpf((float)mantissa, -24);
    return bits & 0x8000 ? -magnitude : magnitude;
}

/* OpenSceneGraph names formats as OpenGL does: GL_RED, GL_RG, GL_RGBA; GL_HALF_FLOAT, GL_FLOAT. */
static void read_back(const lq_image *image) {
    static const int formats[] = {0, 0x1903, 0x8227, 0, 0x1908};
    static char text[OUTPUT];
    static unsigned char bytes[OUTPUT];
    int width, height, depth, format, type;
    run("osgconv t.dds t.osgt >/dev/null 2>&1 && cat t.osgt", text);
    const char *place = strstr(text, "\nSize "), *data;
    assert_non_null(place);
    assert_int_equal(sscanf(place, " Size %d %d %d", &width, &height, &depth), 3);
    assert_int_equal(sscanf(strstr(text, "PixelFormat"), "PixelFormat %d", &format), 1);
    assert_int_equal(sscanf(strstr(text, "DataType"), "DataType %d", &type), 1);
    assert_int_equal(width, image->width);
    assert_int_equal(height, image->height);
    assert_int_equal(depth, image->depth);
    assert_int_equal(format, formats[image->channels]);
    assert_int_equal(type, image->single ? 0x1406 : 0x140B);
    data = strchr(strstr(text, "\nData 1"), '"');
    assert_non_null(data);
    const size_t size = decode(data + 1, bytes), each = image->single ? 4 : 2;
    const size_t count = image->width * image->height * image->depth * (size_t)image->channels;
    assert_int_equal(size, count * each);
    for (size_t i = 0; i < count; i++) {
        float value;
        if (image->single) memcpy(&value, bytes + 4 * i, 4);
        else value = half_value(bytes + 2 * i);
        if (value != image->data[i])
            fail_msg("value %zu: %g read, %g written", i, (double)value, (double)image->data[i]);
    }
    remove(at("t.osgt"));
}

static void expect_line(const char *text, const char *line) {
    if (!strstr(text, line)) fail_msg("no '%s' in\n%s", line, text);
}

static void read_header(const lq_image *image) {
    static const char *const half[] = {"", "54 (R16_FLOAT)", "34 (R16G16_FLOAT)", "",
                                       "10 (R16G16B16A16_FLOAT)"};
    static const char *const single[] = {"", "41 (R32_FLOAT)", "16 (R32G32_FLOAT)", "",
                                         "2 (R32G32B32A32_FLOAT)"};
    static char text[OUTPUT];
    char line[80];
    run("nvddsinfo t.dds 2>&1", text);
    snprintf(line, sizeof line, "Width: %zu\n", image->width);
    expect_line(text, line);
    snprintf(line, sizeof line, "Height: %zu\n", image->height);
    expect_line(text, line);
    snprintf(line, sizeof line, "Depth: %zu\n", image->depth > 1 ? image->depth : 0);
    expect_line(text, line);
    snprintf(line, sizeof line, "Pitch: %zu\n",
             image->width * (size_t)image->channels * (image->single ? 4 : 2));
    expect_line(text, line);
    snprintf(line, sizeof line, "DXGI Format: %s\n", (image->single ? single : half)[image->channels]);
    expect_line(text, line);
    expect_line(text, image->depth > 1 ? "(TEXTURE3D)" : "(TEXTURE2D)");
    snprintf(line, sizeof line, "Array size: %zu\n", image->layers);
    expect_line(text, line);
}

static void test_shapes(void **state) {
    (void)state;
    /* width, height, depth, layers */
    static const size_t shapes[][4] = {{24, 16, 1, 1}, {13, 1, 1, 1}, {7, 5, 3, 1}, {8, 6, 1, 4}};
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++)
        for (int channels = 1; channels <= 4; channels *= 2)
            for (int single = 0; single < 2; single++) {
                const size_t *n = shapes[s];
                lq_image image = make(n[0], n[1], n[2], n[3], channels, single != 0);
                if (have("nvddsinfo")) read_header(&image);
                if (have("osgconv")) read_back(&image); /* of an array, its first layer */
                lq_image_free(&image);
                remove(at("t.dds"));
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shapes)};
    if (!have("osgconv") && !have("nvddsinfo")) {
        fputs("no osgconv (openscenegraph) and no nvddsinfo (libnvtt-bin)\n", stderr);
        return 77;
    }
    return cmocka_run_group_tests_name("pack-dds", tests, make_folder, remove_folder);
}
