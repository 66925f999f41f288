// See cli_info.h.
#include "app/cli_info.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/cli_document_facts.h"
#include "app/cli_support.h"
#include "core/document/codec.h"

namespace tessera::cli {

namespace {

struct Arguments {
    std::string input;
    bool json = false;
};

Json sourceOf(const SourceInfo& source) {
    Json json;
    json["file"] = source.fileName;
    json["format"] = source.format;
    json["width"] = source.width;
    json["height"] = source.height;
    json["bits_per_channel"] = source.bitsPerChannel;
    json["bytes"] = source.byteSize;
    json["sha256"] = source.sha256;
    json["icc_profile_bytes"] = source.iccProfile.size();
    return json;
}

// Stages as "name (variant)" with their figures, for people.
Json stagesByName(const VectorizeReport& report) {
    Json json = Json::object();
    for (const StageReport& stage : report.stages) {
        Json& entry = json[stage.stage + " (" + stage.variant + ")"];
        entry["seconds"] = stage.seconds;
        for (const auto& [name, value] : stage.figures) entry[name] = value;
    }
    return json;
}

int run(const Arguments& arguments) {
    const auto bytes = readFile(arguments.input);
    if (!bytes) return report(bytes.error());
    const auto document = loadDocument(arguments.input);
    if (!document) return report(document.error());
    const auto sizes = chunkSizes(*bytes);
    if (!sizes) return report(sizes.error());

    const PatchMesh& mesh = document->mesh;
    Json json;
    json["width"] = mesh.width();
    json["height"] = mesh.height();
    json["channels"] = mesh.channels();
    json.update(countsOf(mesh));
    json["smooth_joins"] = mesh.smoothJoins().size();
    json["coefficients"] = coefficientCount(mesh);
    json["colour_step"] = *document->colourStep;
    json["bytes"] = bytes->size();
    uint64_t meshBytes = 0;
    Json chunks = Json::object();
    for (const ChunkSize& size : *sizes) {
        chunks[size.tag] = size.bytes;
        for (const char* tag : {"MESH", "GEOM", "CURV", "COLR"})
            if (size.tag == tag) meshBytes += size.bytes;
    }
    json["mesh_bytes"] = meshBytes;
    json["mesh_bytes_per_patch"] = double(meshBytes) / double(mesh.patchCount());
    json["chunks"] = std::move(chunks);
    json["errors"] = document->difference ? toJson(*document->difference) : Json(nullptr);
    json["source"] = sourceOf(document->source);
    json["source_embedded"] = document->embeddedSource != nullptr;
    json["settings"] = toJson(document->settings);
    json["stages"] = arguments.json ? toJson(document->report) : stagesByName(document->report);
    json["shortfall"] = document->report.shortfall;
    if (arguments.json)
        std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    else
        printTable(json);
    return kSuccess;
}

}  // namespace

void addInfoCommand(CLI::App& app, int& exitCode) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        app.add_subcommand("info", "Show a document's counts, errors against its source, sizes and settings");
    command->add_option("document", arguments->input, "The document")->required();
    command->add_flag("--json", arguments->json, "Print one JSON object");
    command->callback([arguments, &exitCode] { exitCode = run(*arguments); });
}

}  // namespace tessera::cli
