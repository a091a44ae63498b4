/* catalogue.h - the catalogue of tables as help text, so that help cannot drift from the code. */
#ifndef LACQUER_PROGRAM_CATALOGUE_H
#define LACQUER_PROGRAM_CATALOGUE_H

#include <stdio.h>

/* One line a table: id, axes, title. */
void cli_print_tables(FILE *out);

/* The same with accepted range, default nodes and meaning of every axis, and the default tolerance. */
void cli_print_axes(FILE *out);

#endif
