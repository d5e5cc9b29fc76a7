// Small archives, record by record.
// SPDX-License-Identifier: MIT
#include "archive_files.h"

#include <cstdint>

#include <zlib.h>

namespace sightline::test {
namespace {

template <class T>
void put(std::string& out, T value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string deflated(const std::string& bytes) {
    z_stream stream = {};
    deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, bytes.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

}  // namespace

std::string pakBytes(const std::vector<MadeEntry>& entries) {
    std::string body, list;
    for (const MadeEntry& entry : entries) {
        std::string name = entry.name;
        name.resize(56, '\0');
        list += name;
        put(list, static_cast<uint32_t>(12 + body.size()));
        put(list, static_cast<uint32_t>(entry.bytes.size()));
        body += entry.bytes;
    }
    std::string out = "PACK";
    put(out, static_cast<uint32_t>(12 + body.size()));
    put(out, static_cast<uint32_t>(list.size()));
    return out + body + list;
}

std::string pk3Bytes(const std::vector<MadeEntry>& entries, const std::string& before) {
    std::string body, list;
    for (const MadeEntry& entry : entries) {
        const std::string packed = entry.deflated ? deflated(entry.bytes) : entry.bytes;
        const auto offset = static_cast<uint32_t>(body.size());
        std::string shared;  // by the entry's header and by the list
        put(shared, uint16_t(20));
        put(shared, uint16_t(0));
        put(shared, static_cast<uint16_t>(entry.deflated ? 8 : 0));
        put(shared, uint32_t(0));
        put(shared, static_cast<uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(entry.bytes.data()),
                                                static_cast<uInt>(entry.bytes.size()))));
        put(shared, static_cast<uint32_t>(packed.size()));
        put(shared, static_cast<uint32_t>(entry.bytes.size()));
        put(shared, static_cast<uint16_t>(entry.name.size()));
        body += std::string("PK\3\4") + shared;
        put(body, uint16_t(2));  // an extra field, which the list lacks
        body += entry.name + "xx" + packed;
        list += std::string("PK\1\2");
        put(list, uint16_t(20));
        list += shared;
        put(list, uint16_t(0));
        put(list, uint16_t(3));
        put(list, uint64_t(0));
        put(list, offset);
        list += entry.name + "say";
    }
    std::string out = before + body + list + "PK\5\6";
    put(out, uint32_t(0));
    put(out, static_cast<uint16_t>(entries.size()));
    put(out, static_cast<uint16_t>(entries.size()));
    put(out, static_cast<uint32_t>(list.size()));
    put(out, static_cast<uint32_t>(body.size()));
    put(out, uint16_t(5));
    return out + "hello";
}

}  // namespace sightline::test
