// Reads KTX2 files with ktx-parse and prints format, size, orientation and the first and last half of level 0.
import { readFileSync } from 'node:fs';
import { read } from 'ktx-parse';
for (const path of process.argv.slice(2)) {
    const file = read(new Uint8Array(readFileSync(path)));
    const level = file.levels[0], data = level.levelData;
    const at = i => data[i] | data[i + 1] << 8;
    const ends = file.supercompressionScheme === 0 ? `${at(0)} ${at(data.length - 2)}` : 'compressed';
    console.log(file.vkFormat, file.pixelWidth, file.pixelHeight, file.pixelDepth, file.layerCount,
        file.supercompressionScheme, level.uncompressedByteLength, file.keyValue.KTXorientation,
        file.dataFormatDescriptor[0].samples.length, ends);
}
