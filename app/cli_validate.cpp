// See cli_validate.h.
#include "app/cli_validate.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/cli_support.h"
#include "core/document/codec.h"
#include "core/mesh/mesh_validate.h"

namespace tessera::cli {

namespace {

struct Arguments {
    std::string input;
    bool json = false;
};

int run(const Arguments& arguments) {
    const auto document = loadDocument(arguments.input);
    if (!document) return report(document.error());
    const MeshValidation validation = validate(document->mesh);
    const SeamStatistics seams = measureSeams(document->mesh);

    Json json;
    json["valid"] = validation.valid();
    json["violation_count"] = validation.violationCount;
    json["min_bernstein"] = validation.minBernstein;
    json["subdivided_patches"] = validation.subdividedPatches;
    json["area_error"] = validation.areaError;
    json["uncovered_pixels"] = validation.uncoveredPixels;
    json["double_pixels"] = validation.doublePixels;
    json["seam_mean"] = seams.mean;
    json["seam_p95"] = seams.p95;
    if (arguments.json) {
        json["violations"] = validation.violations;
        std::printf("%s\n", json.dump(2).c_str());
    } else {
        for (const std::string& violation : validation.violations) std::printf("%s\n", violation.c_str());
        if (validation.violationCount > validation.violations.size())
            std::printf("and %zu more\n", validation.violationCount - validation.violations.size());
        printTable(json);
    }
    if (validation.valid()) return kSuccess;
    return report({ErrorCode::DamagedDocument, "'" + arguments.input + "' has " +
                                                   std::to_string(validation.violationCount) +
                                                   " violations of what a mesh must fulfil"});
}

}  // namespace

void addValidateCommand(CLI::App& app, int& exitCode) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand(
        "validate",
        "Check that a document's patches cover the picture once, without folds; measure its seams");
    command->add_option("document", arguments->input, "The document")->required();
    command->add_flag("--json", arguments->json, "Print one JSON object");
    command->callback([arguments, &exitCode] { exitCode = run(*arguments); });
}

}  // namespace tessera::cli
