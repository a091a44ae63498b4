/* settings.h - settings of callers compiled with an older header. */
#ifndef LACQUER_TABLES_SETTINGS_H
#define LACQUER_TABLES_SETTINGS_H

#include "lacquer.h"

/* What the caller's header knew, the rest as the defaults are. */
lq_status lq_settings_read(lq_settings *settings, const lq_settings *given, lq_error *error);

#endif
