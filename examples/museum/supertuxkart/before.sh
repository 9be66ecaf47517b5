#!/bin/sh
# A copy of a track without its sky, as an add-on: on llvmpipe the sky's light takes minutes before the first frame.
set -e
track=$1/.local/share/supertuxkart/addons/tracks/museum
mkdir -p "$(dirname "$track")"
cp -r /usr/share/games/supertuxkart/data/tracks/hacienda "$track"
sed -i '/<sky-box/d' "$track/scene.xml"
