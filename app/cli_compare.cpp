// See cli_compare.h.
#include "app/cli_compare.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/cli_support.h"
#include "core/image/image_compare.h"
#include "core/image/image_io.h"

namespace tessera::cli {

namespace {

struct Arguments {
    std::string first;
    std::string second;
    bool json = false;
};

int run(const Arguments& arguments) {
    const auto first = readImage(arguments.first);
    if (!first) return report(first.error());
    const auto second = readImage(arguments.second);
    if (!second) return report(second.error());
    const auto difference = compareImages(first->image, second->image);
    if (!difference) return report(difference.error());
    const Json json = toJson(*difference);
    if (arguments.json)
        std::printf("%s\n", json.dump(2).c_str());
    else
        printTable(json);
    return kSuccess;
}

}  // namespace

void addCompareCommand(CLI::App& app, int& exitCode) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("compare", "Measure how far two pictures of one size are apart");
    command->add_option("first", arguments->first, "A picture")->required();
    command->add_option("second", arguments->second, "Another")->required();
    command->add_flag("--json", arguments->json, "Print one JSON object");
    command->callback([arguments, &exitCode] { exitCode = run(*arguments); });
    command->footer(
        "On 8-bit values over white: mae, mae_r/g/b (mean absolute difference), euclid (mean RGB distance), "
        "rmse,\n"
        "psnr (dB), mae_luma, psnr_luma (Rec. 601), ssim (Wang et al. 2004 on luma). null: infinite, or too "
        "small.");
}

}  // namespace tessera::cli
