// Writes a grid with another compression, or prints the values of OpenVDB's samplers at points. See make.py.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <cstdio>
#include <iostream>
#include <string>

int main(int count, char** words)
{
    openvdb::initialize();
    const std::string task = count > 3 ? words[1] : "";
    if (task == "write" && count == 5) {
        const std::string kind = words[4];
        openvdb::io::File from(words[2]);
        from.open(/*delayLoad=*/false);
        const auto grids = from.getGrids();
        openvdb::io::File to(words[3]);
        uint32_t flags = openvdb::io::COMPRESS_NONE;
        if (kind.find("zip") != std::string::npos) flags |= openvdb::io::COMPRESS_ZIP;
        if (kind.find("blosc") != std::string::npos) flags |= openvdb::io::COMPRESS_BLOSC;
        if (kind.find("mask") != std::string::npos) flags |= openvdb::io::COMPRESS_ACTIVE_MASK;
        to.setCompression(flags);
        to.write(*grids);
        return 0;
    }
    if (task == "sample" && count == 4) {
        openvdb::io::File file(words[2]);
        file.open(false);
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(words[3]));
        double x, y, z;
        while (std::cin >> x >> y >> z) {
            const openvdb::Vec3d at(x, y, z);
            const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> box(*grid);
            const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::PointSampler> point(*grid);
            std::printf("%.9g %.9g\n", double(box.wsSample(at)), double(point.wsSample(at)));
        }
        return 0;
    }
    return 1;
}
