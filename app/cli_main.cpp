// The program tessera-cli: reads the command line and hands over to a command.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>

#include "app/cli_bench.h"
#include "app/cli_compare.h"
#include "app/cli_info.h"
#include "app/cli_render.h"
#include "app/cli_stages.h"
#include "app/cli_support.h"
#include "app/cli_validate.h"
#include "app/cli_vectorize.h"

int main(int argc, char** argv) {
    using namespace tessera;
    CLI::App app(
        "Tessera turns photographs into vector images of curved patches and draws them at any size.\n"
        "  tessera-cli vectorize photo.jpg -o photo.tessera --patches 4000\n"
        "  tessera-cli render photo.tessera -o large.png --width 8000",
        "tessera-cli");
    app.set_version_flag("--version", "tessera-cli " TESSERA_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done, 2 wrong usage, 3 cannot read, 4 damaged document, 5 cannot write, 6 internal "
        "error,\n"
        "130 stopped. 'tessera-cli COMMAND --help' shows a command's options.");
    int exitCode = cli::kSuccess;
    cli::addVectorizeCommand(app, exitCode);
    cli::addRenderCommand(app, exitCode);
    cli::addInfoCommand(app, exitCode);
    cli::addValidateCommand(app, exitCode);
    cli::addCompareCommand(app, exitCode);
    cli::addStagesCommand(app, exitCode);
    cli::addBenchCommand(app, exitCode);
    // CLI11 would only say that a command is missing.
    const auto commands = app.get_subcommands([](const CLI::App*) { return true; });
    if (argc > 1 && argv[1][0] != '-' &&
        std::none_of(commands.begin(), commands.end(),
                     [&](const CLI::App* c) { return c->get_name() == argv[1]; }))
        return cli::report(
            {ErrorCode::Usage, "there is no command '" + std::string(argv[1]) + "'; see tessera-cli --help"});
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return cli::report({ErrorCode::Usage, std::string(error.what()) + "; see tessera-cli --help"});
    } catch (const std::bad_alloc&) {
        return cli::report({ErrorCode::Internal, "memory ran out; try a smaller picture or fewer patches"});
    } catch (const std::exception& error) {
        return cli::report({ErrorCode::Internal, std::string("unexpected failure: ") + error.what()});
    }
    return exitCode;
}
