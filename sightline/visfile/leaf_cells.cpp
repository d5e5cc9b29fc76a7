// Codes the numbers of leaves' cells, and back.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/leaf_cells.h"

#include "sightline/base/bytes.h"
#include "sightline/cells/cells.h"
#include "sightline/visfile/bit_coder.h"
#include "sightline/visfile/section_file.h"

namespace sightline {
namespace {

uint16_t inFile(uint32_t cell) { return cell == CellGraph::kNoCell ? kNoCellInFile : static_cast<uint16_t>(cell); }

/// The same steps put numbers and take them.
template <class Coder>
class LeafCoder {
public:
    explicit LeafCoder(Coder& coder) : coder_(coder) {}

    /// @returns the number; perhaps out of range, if it is taken from what was never put
    int32_t code(int32_t cell) {
        const uint32_t before = how_;
        if (coder_.code(same_[before], cell == last_)) {
            how_ = 0;
            return last_;
        }
        if (coder_.code(fresh_[before], cell == fresh_cell_)) {
            how_ = 1;
            return last_ = fresh_cell_++;
        }
        how_ = 2;
        const int32_t step = cell - last_;
        last_ += unfoldSign(step_.code(coder_, foldSign(step)));
        if (last_ >= fresh_cell_ && last_ != kNoCellInFile) fresh_cell_ = last_ + 1;
        return last_;
    }

private:
    Coder& coder_;
    int32_t last_ = 0, fresh_cell_ = 0;  ///< fresh: one more than the largest cell so far
    uint32_t how_ = 0;                   ///< the last number came to be
    BitModel same_[3], fresh_[3];
    NumberModel step_;
};

constexpr size_t kLeafHeadBytes = 4;

}  // namespace

Array<char> leafCells(std::span<const uint32_t> cell_of_leaf, Memory* memory) {
    Array<char> bytes(memory);
    ByteWriter out(bytes);
    for (const uint32_t cell : cell_of_leaf) out.put(inFile(cell));
    return bytes;
}

Array<char> packedLeafCells(std::span<const uint32_t> cell_of_leaf, Memory* memory) {
    Array<char> bytes(memory);
    ByteWriter(bytes).put(static_cast<uint32_t>(cell_of_leaf.size()));
    BitEncoder encoder(bytes);
    LeafCoder<BitEncoder> leaves(encoder);
    for (const uint32_t cell : cell_of_leaf) leaves.code(inFile(cell));
    encoder.finish();
    return bytes;
}

Result<Array<char>> unpackedLeafCells(std::span<const char> bytes, std::string_view file, uint64_t at, Memory* memory) {
    if (bytes.size() < kLeafHeadBytes)
        return faultAt(file, "packed leaves that end within their head", at + bytes.size());
    const uint32_t leaves = ByteCursor(bytes).take<uint32_t>();
    BitDecoder decoder(bytes.subspan(kLeafHeadBytes));
    LeafCoder<BitDecoder> coder(decoder);
    Array<char> numbers(memory);
    ByteWriter out(numbers);
    for (uint32_t leaf = 0; leaf < leaves; ++leaf) {
        const int32_t cell = coder.code(-1);
        if (cell < 0 || cell > kNoCellInFile || decoder.pastEnd())
            return faultAt(file, "packed leaves with what is no cell, or fewer than they say", at + bytes.size());
        out.put(static_cast<uint16_t>(cell));
    }
    if (!decoder.atEnd()) return faultAt(file, "packed leaves that do not end with their bytes", at + bytes.size());
    return numbers;
}

}  // namespace sightline
