/// Writes the pages that the browser tests open.  Usage: planted_page FOLDER
#include <filesystem>

#include "planted_report.hpp"

int main(int argc, char** argv) {
  using namespace rejoin;
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  report::write_run_report(report::planted_report(), folder / "hostile.html", Context());
  report::RunReport posed = report::planted_report();
  posed.constraints.must_not_join.clear();
  report::write_run_report(posed, folder / "posed.html", Context());
  report::RunReport none;
  none.title = "nothing";
  report::write_run_report(none, folder / "empty.html", Context());
  // The viewer's cost is in the surfaces and pictures, and a row of balls has the most of both.
  report::write_run_report(report::long_row(60, 90), folder / "sixty.html", Context());
  report::write_run_report(report::long_row(200, 4), folder / "many.html", Context());
  return 0;
}
