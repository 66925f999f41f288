// See cli_bench_table.h.
#include "app/cli_bench_table.h"

#include <algorithm>
#include <cstdio>
#include <map>

namespace tessera::cli {

namespace {

std::string cell(const Json& row, const Column& column) {
    const auto found = row.find(column.key);
    if (found == row.end() || found->is_null()) return "-";
    if (found->is_string()) return found->get<std::string>();
    if (found->is_boolean()) return found->get<bool>() ? "yes" : "no";
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", column.decimals, found->get<double>() * column.factor);
    return text;
}

}  // namespace

std::vector<Json> meansOf(const std::vector<Json>& rows, const std::vector<std::string>& keys) {
    std::vector<Json> means;
    std::vector<std::map<std::string, size_t>> counts;
    for (const Json& row : rows) {
        const auto same = [&](const Json& mean) {
            return std::ranges::all_of(keys, [&](const std::string& key) { return mean[key] == row[key]; });
        };
        auto at = size_t(std::ranges::find_if(means, same) - means.begin());
        if (at == means.size()) {
            Json& mean = means.emplace_back(Json{{"picture", "mean"}});
            for (const std::string& key : keys) mean[key] = row[key];
            counts.emplace_back();
        }
        for (const auto& [key, value] : row.items()) {
            if (!value.is_number() || std::ranges::find(keys, key) != keys.end()) continue;
            const double before = counts[at][key]++ == 0 ? 0 : means[at][key].get<double>();
            means[at][key] = before + value.get<double>();
        }
    }
    for (size_t i = 0; i < means.size(); ++i)
        for (const auto& [key, count] : counts[i])
            means[i][key] = means[i][key].get<double>() / double(count);
    return means;
}

void printFigures(const std::string& title, const std::vector<Column>& columns,
                  const std::vector<Json>& rows) {
    std::vector<std::vector<std::string>> cells{{}};
    for (const Column& column : columns) cells[0].push_back(column.title);
    for (const Json& row : rows) {
        std::vector<std::string>& line = cells.emplace_back();
        for (const Column& column : columns) line.push_back(cell(row, column));
    }
    std::printf("%s\n\n", title.c_str());
    std::vector<size_t> widths(columns.size(), 3);
    for (const auto& line : cells)
        for (size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
    const auto isText = [&](size_t c) {
        return !rows.empty() && rows[0].value(columns[c].key, Json()).is_string();
    };
    for (size_t r = 0; r < cells.size(); ++r) {
        for (size_t c = 0; c < columns.size(); ++c) {
            const int width = int(widths[c]);
            std::printf("| %*s ", isText(c) ? -width : width, cells[r][c].c_str());
        }
        std::printf("|\n");
        if (r > 0) continue;
        for (size_t c = 0; c < columns.size(); ++c)
            std::printf("|%s%s", std::string(widths[c] + 1, '-').c_str(), isText(c) ? "-" : ":");
        std::printf("|\n");
    }
    std::printf("\n");
}

}  // namespace tessera::cli
