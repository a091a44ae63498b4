/* document.c - the frame of every page. */
#include "picture/document.h"

#include "picture/page_parts.h"
#include "picture/plot_parts.h"
#include "picture/text.h"

void lq_document_begin(FILE *out, const char *title) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
          out);
    lq_text_put(out, title);
    fprintf(out, "</title>\n<style>\n%s%s</style>\n</head>\n<body>\n<h1>", lq_page_style, lq_plot_style);
    lq_text_put(out, title);
    fputs("</h1>\n", out);
}

void lq_document_end(FILE *out) {
    fputs("</body>\n</html>\n", out);
}

void lq_document_verdict(FILE *out, bool good, const char *verdict, const char *date, const char *words) {
    fprintf(out, "<p class=\"verdict\"><b class=\"%s\">", good ? "passed" : "failed");
    lq_text_put(out, verdict);
    fputs("</b> ", out);
    lq_text_put(out, words);
    if (*date) fprintf(out, " <time datetime=\"%s\">%s</time>", date, date);
    fputs("</p>\n", out);
}

void lq_document_table(FILE *out, const char *const *heads, size_t count) {
    fputs("<div class=\"wide\"><table>\n<tr>", out);
    for (size_t i = 0; i < count; i++) fprintf(out, "<th>%s</th>", heads[i]);
    fputs("</tr>\n", out);
}

void lq_document_table_end(FILE *out) {
    fputs("</table></div>\n", out);
}

void lq_document_heading(FILE *out, int level, const char *id, const char *text) {
    fprintf(out, "<h%d class=\"apart\"", level);
    if (id) {
        fputs(" id=\"", out);
        lq_text_put(out, id);
        fputc('"', out);
    }
    fputc('>', out);
    lq_text_put(out, text);
    fprintf(out, "</h%d>\n", level);
}
