// What impinge step found out about each method, and how it is written down: methods.csv, solution_METHOD.csv,
// history_METHOD.csv, work_precision.csv, history.png, work_precision.png.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/types.hpp"

namespace impinge {

/// One run that was stopped early.
struct WorkPoint {
  int iterations_allowed = 0;
  double ms = 0.0, residual = 0.0;  ///< residual as in MethodReport
  double distance = 0.0;
};

/// What a method made of the step. Figures that are not finite are not known, and left blank where they are written.
struct MethodReport {
  std::string method;
  int iterations = 0, outer_iterations = 0;
  double ms = 0.0;
  /// relative: of a frozen step by natural map and momentum, of a published problem Siconos'
  double residual = 0.0;
  std::string stop_reason;
  double natural_map = 0.0, natural_map_relative = 0.0, momentum = 0.0;  ///< m/s, 1, m/s
  int worst_contact = -1;
  double complementarity = 0.0, cone_violation = 0.0;  ///< J, N·s
  double distance = 0.0;                               ///< to the exact solution, relative
  bool distance_is_bound = false;                      ///< it is less than that, which rounding makes
  double distance_of_lambda = 0.0;                     ///< of a published problem: of λ itself, relative
  std::vector<Vec3> lambda;     ///< empty where there is no finite answer; the stop reason then says why
  std::vector<double> history;  ///< residual before the first and after each iteration
  std::vector<WorkPoint> work;
};

struct StepReport {
  std::string title;                           ///< of the plots
  std::string residual_label, distance_label;  ///< of the plots' axes
  bool plots_distance = false;                 ///< work_precision.png shows the distance, else the residual
  std::string solution_head;  ///< columns of solution_METHOD.csv between `contact` and `r_n`, each with its comma
  std::vector<std::string> solution_columns;  ///< by contact, what they hold
  std::vector<MethodReport> methods;
};

/// Numbers of iterations to stop after, so that a method is seen on its way: 1, 2, 4, … below `most`.
std::vector<int> early_stops(int most);

/// Prints as the reports come in. RESPONSE-SOLVER stands as a solver under the line of its response.
class TablePrinter {
 public:
  /// A published problem has neither outer iterations nor momentum.
  explicit TablePrinter(bool has_bodies);
  void row(const MethodReport& report);

 private:
  bool has_bodies_;
  std::string response_;
};

/// Makes the folder where it isn't. Throws InputError where something can't be written.
void write_report(const std::filesystem::path& folder, const StepReport& report);

}  // namespace impinge
