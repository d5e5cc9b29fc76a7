// IFC files, written entity by entity.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::test {

/// A file with a project and a geometric context; z is up, as in IFC. All attributes that may be absent are.
class IfcFile {
public:
    static constexpr const char* kMetre = "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)";

    /// @param unit  an entity; more of them, which it refers to, may be added before as #900 and on
    explicit IfcFile(const std::string& schema = "IFC4", const std::string& unit = kMetre);

    /// Adds an entity. @return its number
    uint32_t add(const std::string& entity);
    /// All of the file.
    std::string text() const;

    uint32_t point(const glm::dvec3& p);
    /// A placement of products.
    uint32_t place(const glm::dvec3& at);

    // Boxes from a corner, as geometry.
    uint32_t extruded(const glm::dvec3& corner, const glm::dvec3& size);
    uint32_t brep(const glm::dvec3& corner, const glm::dvec3& size);
    uint32_t triangulated(const glm::dvec3& corner, const glm::dvec3& size);
    uint32_t polygonal(const glm::dvec3& corner, const glm::dvec3& size);

    uint32_t representation(const std::vector<uint32_t>& items, const std::string& identifier = "'Body'",
                            const std::string& type = "$");
    /// @param more  attributes behind the eighth, as ",$"
    uint32_t product(const std::string& type, const std::string& name, const std::vector<uint32_t>& representations,
                     const std::string& more = ",$", uint32_t placement = 0);
    /// A product with one item as its body.
    uint32_t solid(const std::string& type, const std::string& name, uint32_t item, const std::string& more = ",$");
    /// Something of the spatial structure, without a shape.
    uint32_t spatial(const std::string& type, const std::string& name, const std::string& more);

    void cut(uint32_t host, uint32_t opening);
    void aggregate(uint32_t whole, const std::vector<uint32_t>& parts);
    void contain(uint32_t place, const std::vector<uint32_t>& things);
    /// Gives an item a colour. @param transparency  an attribute, "0.5" or "$"
    void style(uint32_t item, const std::string& transparency);
    uint32_t surfaceStyle(const std::string& transparency);

    static std::string refs(const std::vector<uint32_t>& ids);
    uint32_t project() const { return 1; }
    uint32_t context() const { return 5; }

private:
    std::string globalId();

    std::string schema_, data_;
    uint32_t next_ = 1000, ids_ = 0;
};

}  // namespace sightline::test
