/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/regression_report.h"

#include "common/file.h"
#include "report/regression_parts.h"

#include <limits.h>

/* results.json is last: if it exists, the report is complete. */
static const struct {
    const char *name;
    void (*write)(FILE *file, const void *report);
} parts[] = {{"report.html", report_write_page},
             {"junit.xml", report_write_junit},
             {"results.tap", report_write_tap},
             {"results.json", report_write_json}};

bool regression_report_write(Regression *regression, const char *folder, size_t max_bytes, const Progress *progress,
                             Error *error) {
    ReportPictures pictures;
    ReportRuns runs = {0};
    char path[PATH_MAX];
    if (!file_make_directory(folder, error) ||
        !report_pictures_gather(&pictures, regression, max_bytes, progress, error))
        return false;
    const Report report = {regression, &pictures, &runs, folder};
    bool ok = report_runs_write(&runs, regression, folder, max_bytes, progress, error);
    for (size_t i = 0; ok && i < sizeof parts / sizeof parts[0]; i++) {
        ok = file_path(path, sizeof path, error, "%s/%s", folder, parts[i].name) &&
             file_write_text(path, parts[i].write, &report, error);
    }
    report_runs_free(&runs);
    report_pictures_free(&pictures);
    return ok;
}
