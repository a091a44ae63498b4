#!/usr/bin/env bash
# test_faults.sh at every call.
exec env LACQUER_FAULT_STEP=1 bash "${LACQUER_SOURCE:?source folder}/tests/test_faults.sh"
