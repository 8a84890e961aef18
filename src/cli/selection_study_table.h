#pragma once
// What `goniofit verify --selection` prints.

#include <string>

#include "../report/fit_report.h"
#include "../synthetic/selection_study.h"

namespace goniofit::cli {

[[nodiscard]] std::string selection_study_text(const SelectionStudy& study, const ReportStyle& style);
/// {"selection": {"scans", "right", "left_out", "passed", "misses": [...]}, "passed": ...}.
[[nodiscard]] std::string selection_study_json(const SelectionStudy& study);

}  // namespace goniofit::cli
