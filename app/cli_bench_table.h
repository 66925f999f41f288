// Tables of figures for people, and means over pictures.
#pragma once

#include <string>
#include <vector>

#include "app/cli_support.h"

namespace tessera::cli {

struct Column {
    std::string title;
    std::string key;  // of the figure in a row
    int decimals = 2;
    double factor = 1;
};

// For each combination of the values of `keys` in `rows`, in order of appearance, a row with those values,
// with "picture" set to "mean", and with each figure's mean over the rows in which it is a number.
std::vector<Json> meansOf(const std::vector<Json>& rows, const std::vector<std::string>& keys);

// Prints `title` and the rows as an aligned Markdown table on stdout; '-' for a figure that a row lacks.
void printFigures(const std::string& title, const std::vector<Column>& columns,
                  const std::vector<Json>& rows);

}  // namespace tessera::cli
