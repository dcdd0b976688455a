// Halflight for Nextflow: a picture of each volume. params.options: more options of `halflight render`.
process HALFLIGHT_RENDER {
    tag "${meta.id}"
    label 'process_medium'

    input:
    tuple val(meta), path(volume)

    output:
    tuple val(meta), path("${meta.id}.png"), emit: picture
    path "versions.yml", emit: versions

    script:
    def options = task.ext.args ?: ''
    """
    halflight render ${volume} --threads ${task.cpus} --quiet ${options} -o ${meta.id}.png
    printf '"%s":\\n    halflight: %s\\n' "${task.process}" "\$(halflight --version | cut -d' ' -f2)" > versions.yml
    """

    stub:
    """
    touch ${meta.id}.png versions.yml
    """
}

workflow {
    Channel.fromPath(params.volumes).map { [[id: it.simpleName], it] } | HALFLIGHT_RENDER
}
