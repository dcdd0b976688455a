# A PNG of a figure carries the figure, and repeats it; it is a picture as a panel, and no scene.
tool ball 16 ball_16x16x16_uint8.raw
cat >page.json <<'END'
{"width": "20mm", "dpi": 100, "panels": [{"input": "ball_16x16x16_uint8.raw"}, {"input": "ball_16x16x16_uint8.raw", "iso": "90", "shadows": "off"}]}
END
halflight figure page.json --dpi 150 --quiet -o page.png || { echo "this build draws nothing"; exit 77; }
halflight figure page.png --quiet -o again.png
cmp page.png again.png && echo repeated
halflight info page.png | grep figure
halflight render page.png -o no.png 2>message || echo $? "$(cut -c12-110 message)"
echo '{"width": "20mm", "panels": [{"input": "page.png"}]}' >outer.json
halflight figure outer.json --quiet -o outer.png && echo shown
halflight render ball_16x16x16_uint8.raw --size 16 --quiet -o scene.png
halflight figure scene.png -o no.png 2>message || echo $? "$(cut -c12-110 message)"
halflight render ball_16x16x16_uint8.raw --size 16 --no-metadata --quiet -o bare.png
halflight figure bare.png -o no.png 2>message || echo $? "$(cut -c12-110 message)"
