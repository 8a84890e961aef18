#pragma once
// The subcommands. Each adds itself to the program; its callback stores the exit status.

#include <CLI/CLI.hpp>

namespace goniofit::cli {

void add_inspect(CLI::App& program, int& status);
void add_fit(CLI::App& program, int& status);
void add_compare(CLI::App& program, int& status);
void add_simulate(CLI::App& program, int& status);
void add_eval(CLI::App& program, int& status);
void add_verify(CLI::App& program, int& status);
void add_tradeoff(CLI::App& program, int& status);
void add_plan(CLI::App& program, int& status);
void add_render(CLI::App& program, int& status);
void add_export(CLI::App& program, int& status);
void add_curves(CLI::App& program, int& status);
void add_report(CLI::App& program, int& status);
void add_models(CLI::App& program, int& status);

}  // namespace goniofit::cli
