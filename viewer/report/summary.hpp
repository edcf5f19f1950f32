// The first lines of a sweep's report, for somebody who was not there.
#pragma once

#include "viewer/report/parts.hpp"
#include "viewer/report/sweep_report.hpp"

namespace impinge {

std::string summary_html(const SweepReport& report, const ReportTable& table, const ReportChoice& choice,
                         const Session& base);

}  // namespace impinge
