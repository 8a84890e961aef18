// The program: subcommands, and the one place where errors become messages and exit statuses.

#include <csignal>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/page_source.h"
#include "support/error.h"
#include "support/text.h"

namespace {

using goniofit::ErrorKind;

// CLI11 only says that a command is required; which one was meant, and which there are, helps more.
std::string complaint(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv) {
  if (!program.get_subcommands().empty()) return error.what();
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  const std::string expected = ", expected " + goniofit::alternatives(names);
  if (argc < 2) return "no command" + expected;
  return argv[1][0] == '-' ? error.what() : "no command " + goniofit::in_quotes(argv[1]) + expected;
}

int usage_failure(const CLI::App& program, const std::string& what) {
  const auto chosen = program.get_subcommands();
  std::cerr << what << "\nsee goniofit " << (chosen.empty() ? "" : chosen.front()->get_name() + " ") << "--help\n";
  return static_cast<int>(ErrorKind::bad_input);
}

int run(int argc, char** argv) {
  int status = 0;
  goniofit::cli::remember_command({argv + 1, argv + argc});
  CLI::App program("Fits the Li-Torrance reflectance model to BRDF measurements.", "goniofit");
  program.set_version_flag("--version", "goniofit " GONIOFIT_VERSION);
  program.require_subcommand(1);
  program.footer(
      "goniofit COMMAND --help explains one command, with an example.\n"
      "Exit status: 0 done, 1 the result fails, 2 bad usage or input, 3 the system failed.");
  goniofit::cli::add_inspect(program, status);
  goniofit::cli::add_fit(program, status);
  goniofit::cli::add_compare(program, status);
  goniofit::cli::add_simulate(program, status);
  goniofit::cli::add_eval(program, status);
  goniofit::cli::add_verify(program, status);
  goniofit::cli::add_tradeoff(program, status);
  goniofit::cli::add_plan(program, status);
  goniofit::cli::add_render(program, status);
  goniofit::cli::add_export(program, status);
  goniofit::cli::add_curves(program, status);
  goniofit::cli::add_report(program, status);
  goniofit::cli::add_models(program, status);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return usage_failure(program, complaint(program, error, argc, argv));
    program.exit(error);  // --help and --version
  }
  std::cout.flush();
  if (!std::cout) throw goniofit::system_error("cannot write standard output");
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  // A file that grows beyond the limit shall be an error like a full disk, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const goniofit::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    std::cerr << "goniofit: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "goniofit: unexpected failure: " << error.what() << '\n';
  }
  return static_cast<int>(ErrorKind::system);
}
