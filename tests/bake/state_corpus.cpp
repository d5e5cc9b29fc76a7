// Writes seeds for the fuzzer of bakes' states.
// SPDX-License-Identifier: MIT
#include "tests/bake/state_check.h"
#include "tests/support/files.h"

int main(int argc, char** argv) {
    using namespace sightline::test;
    return writeSeeds(argc, argv, [](auto seed) {
        sightline::bake::RowJournal journal;
        smallBake().rows(journal);
        const std::string rows = journal.bytes(), cells = smallBake().cellState(0);
        std::string damaged = rows + cells;
        damaged[rows.size() / 2] ^= 1;
        seed("journal.state", rows);
        seed("cells.state", cells);
        seed("both.state", rows + cells);
        seed("cut.state", cells.substr(0, cells.size() / 2));
        seed("damaged.state", damaged);
    });
}
