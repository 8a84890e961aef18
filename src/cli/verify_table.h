#pragma once
// What `goniofit verify` prints.

#include <string>
#include <vector>

#include "../report/fit_report.h"
#include "../synthetic/verify.h"

namespace goniofit::cli {

[[nodiscard]] std::string verify_table(const VerifyReport& report, const ReportStyle& style);
[[nodiscard]] std::string random_recovery_text(const RandomRecoveryReport& report, const ReportStyle& style);
/// {"recipes": [...], "random": {...} or null, "passed": ...}.
[[nodiscard]] std::string verify_json(const std::vector<VerifyReport>& reports, const RandomRecoveryReport* random);

/// No bound missed.
[[nodiscard]] bool passed(const VerifyReport& report) noexcept;
/// No wrong minimum.
[[nodiscard]] bool passed(const RandomRecoveryReport& report) noexcept;

}  // namespace goniofit::cli
