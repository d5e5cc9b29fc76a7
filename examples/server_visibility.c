// A game server that sends each player only what that player may see: nothing is left on the wire for a wall hack.
// SPDX-License-Identifier: MIT
//
// Rooms in a square, with doors between some of them. Players walk through them; the server asks, for each of them and in each tick, which
// others may be seen from anywhere that he may stand by the time he hears of it.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <sightline/c/bake/bake.h>
#include <sightline/c/sightline.h>

enum { kSide = 6, kRooms = kSide * kSide, kPlayers = 64, kTicks = 200, kFirstDoor = 1000 };
static const double kSize = 8, kHeight = 3, kSpeed = 5, kLatency = 0.15; /* units, units, units/s, s */

/* Doors stand to and fro, so that one does not see through all of them at once: along a room's wall, from its middle. */
static double doorOffset(int x, int z) { return (x + z) % 2 ? 2.5 : -2.5; }

/* Whether a room has a door in the wall at its upper end. */
static bool hasDoor(int x, int z, int axis) {
    return (axis == 0 ? x : z) < kSide - 1 && (axis == 0 || (x + 2 * z) % 3 == 0);
}

/* What a level's maker knows: rooms, and the holes between them, each with a door. */
static slBaked* bakeRooms(void) {
    static slBakeCell rooms[kRooms];
    static slBakePortal portals[2 * kRooms];
    static double corners[2 * kRooms][4][3];
    static slBakeObject doors[2 * kRooms];
    static char names[2 * kRooms][24];
    const float leaf[] = {0, 0, 0, 1, 0, 0, 1, 2, 0}; /* a door's leaf; what it looks like does not matter here */
    slBakeMesh mesh;
    memset(&mesh, 0, sizeof mesh);
    slBakeDef def = slDefaultBakeDef();
    size_t holes = 0;
    for (int z = 0; z < kSide; ++z)
        for (int x = 0; x < kSide; ++x) {
            const slBox box = {{x * kSize, 0, z * kSize}, {(x + 1) * kSize, kHeight, (z + 1) * kSize}};
            rooms[z * kSide + x].box = box;
            for (int axis = 0; axis < 2; ++axis) {
                if (!hasDoor(x, z, axis)) continue;
                const double at = ((axis == 0 ? x : z) + 1) * kSize,
                             middle = ((axis == 0 ? z : x) + 0.5) * kSize + doorOffset(x, z);
                for (int k = 0; k < 4; ++k) {
                    const double along = middle + (k == 0 || k == 3 ? -0.5 : 0.5);
                    corners[holes][k][0] = axis == 0 ? at : along;
                    corners[holes][k][1] = k < 2 ? 0 : 2;
                    corners[holes][k][2] = axis == 0 ? along : at;
                }
                portals[holes].cells[0] = (uint32_t)(z * kSide + x);
                portals[holes].cells[1] = (uint32_t)(axis == 0 ? z * kSide + x + 1 : (z + 1) * kSide + x);
                portals[holes].corners = (const double(*)[3])corners[holes];
                portals[holes].corner_count = 4;
                portals[holes].door = (uint32_t)holes;
                snprintf(names[holes], sizeof names[holes], "door %u", (unsigned)holes);
                doors[holes].name = names[holes];
                doors[holes].key = kFirstDoor + holes;
                doors[holes].moves = true;
                for (int d = 0; d < 16; d += 5) doors[holes].transform[d] = 1;
                doors[holes].transform[12] = corners[holes][0][0];
                doors[holes].transform[14] = corners[holes][0][2];
                ++holes;
            }
        }
    mesh.mesh.positions = leaf;
    mesh.mesh.vertex_count = 3;
    def.meshes = &mesh;
    def.mesh_count = 1;
    def.objects = doors;
    def.object_count = holes;
    def.cells = rooms;
    def.cell_count = kRooms;
    def.portals = portals;
    def.portal_count = holes;
    def.trusted = true;
    slBaked* baked = NULL;
    return slBake(&def, &baked) == SL_OK ? baked : NULL;
}

typedef struct Player {
    double at[3], to[3], then[3]; /* through a door to the middle of a room */
    slObjectId id;
} Player;

static int roomOf(const double at[3]) { return (int)(at[2] / kSize) * kSide + (int)(at[0] / kSize); }

/* From the middle of a room to that of a neighbour, through the door between. */
static void chooseWay(Player* player) {
    const int room = roomOf(player->at), x = room % kSide, z = room / kSide, along_x = rand() % 2, forth = rand() % 2;
    const int nx = x + (along_x ? (forth ? 1 : -1) : 0), nz = z + (along_x ? 0 : (forth ? 1 : -1));
    const int dx = nx < x ? nx : x, dz = nz < z ? nz : z; /* the room that the door was made with */
    if (nx < 0 || nz < 0 || nx >= kSide || nz >= kSide || !hasDoor(dx, dz, along_x ? 0 : 1)) return;
    player->to[0] = along_x ? (dx + 1) * kSize : (x + 0.5) * kSize + doorOffset(dx, dz);
    player->to[2] = along_x ? (z + 0.5) * kSize + doorOffset(dx, dz) : (dz + 1) * kSize;
    player->then[0] = (nx + 0.5) * kSize;
    player->then[2] = (nz + 0.5) * kSize;
}

static void walk(Player* player, double seconds) {
    double left = kSpeed * seconds;
    while (left > 0) {
        const double dx = player->to[0] - player->at[0], dz = player->to[2] - player->at[2], away = hypot(dx, dz);
        if (away < 1e-9) {
            const bool arrived = player->to[0] == player->then[0] && player->to[2] == player->then[2];
            if (arrived) chooseWay(player);
            else memcpy(player->to, player->then, sizeof player->to);
            continue;
        }
        const double step = away < left ? away : left;
        player->at[0] += step * dx / away;
        player->at[2] += step * dz / away;
        left -= step;
    }
}

int main(void) {
    slBaked* const baked = bakeRooms();
    if (!baked) return 1;
    size_t size = 0;
    const void* const bytes = slBakedBytes(baked, &size);
    slVisibility* file = NULL;
    slWorld* world = NULL;
    slSight* sight = NULL;
    const slWorldDef def = slDefaultWorldDef();
    if (slOpenVisibility(bytes, size, "rooms", NULL, &file) != SL_OK || slCreateWorld(&def, &world) != SL_OK) return 1;
    if (slAttach(world, file) != SL_OK || slCreateSight(NULL, &sight) != SL_OK) return 1;

    static Player players[kPlayers];
    srand(1);
    for (int i = 0; i < kPlayers; ++i) {
        slObjectDef body = slDefaultObjectDef();
        const slBox bounds = {{-0.4, -1.6, -0.4}, {0.4, 0.2, 0.4}}; /* around the eyes */
        body.bounds = bounds;
        body.key = (uint64_t)i;
        const double middle[3] = {(rand() % kSide + 0.5) * kSize, 1.7, (rand() % kSide + 0.5) * kSize};
        memcpy(players[i].at, middle, sizeof middle);
        memcpy(players[i].to, middle, sizeof middle);
        memcpy(players[i].then, middle, sizeof middle);
        if (slAddObject(world, &body, &players[i].id) != SL_OK) return 1;
    }

    size_t sent = 0, all = 0, wrong = 0;
    for (int tick = 0; tick < kTicks; ++tick) {
        for (int i = 0; i < kPlayers; ++i) {
            double transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
            walk(&players[i], 1.0 / 30);
            memcpy(transform + 12, players[i].at, sizeof players[i].at);
            slMoveObject(world, players[i].id, transform);
        }
        slSnapshot* now = NULL;
        if (slCommit(world, &now) != SL_OK) return 1;
        for (int i = 0; i < kPlayers; ++i) {
            /* Where he may be, and look from, by the time that the packet arrives. */
            const double reach = kSpeed * kLatency;
            slBox region;
            for (int axis = 0; axis < 3; ++axis) {
                region.low[axis] = players[i].at[axis] - (axis == 1 ? 0.2 : reach);
                region.high[axis] = players[i].at[axis] + (axis == 1 ? 0.2 : reach);
            }
            slRegionSet seen;
            if (slSightFrom(sight, now, &region, ~0u, &seen) != SL_OK) return 1;
            bool told[kPlayers] = {false};
            for (uint32_t k = 0; k < seen.count; ++k)
                if (seen.objects[k].key < kPlayers) told[seen.objects[k].key] = true;
            for (int k = 0; k < kPlayers; ++k) {
                sent += told[k] && k != i;
                all += k != i;
                /* Who is in the same room must never be missing. */
                wrong += !told[k] && roomOf(players[i].at) == roomOf(players[k].at);
            }
        }
        slReleaseSnapshot(now);
    }
    printf("%u rooms; of %zu positions of others %zu are sent: %.0f %%; %zu that are in sight are missing\n",
           (unsigned)slBakedCells(baked), all, sent, 100.0 * (double)sent / (double)all, wrong);
    slDestroySight(sight);
    slDestroyWorld(world);
    slCloseVisibility(file);
    slDestroyBaked(baked);
    return wrong == 0 && sent < all / 2 ? 0 : 1;
}
